// The grids of an untrusted OpenVDB file.
#pragma once

#include <openvdb/openvdb.h>
// These headers depend on the one above.
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <fstream>
#include <string>
#include <vector>

namespace snowshed {

/// Reads grids as openvdb::io::File does, but notices the end of the file. io::File reads zeros
/// from a file that ends too early; here the stream throws std::ios_base::failure.
class GridFile : private openvdb::io::Archive {
 public:
  /// Reads the header and the list of grids. Throws InputError, openvdb::Exception or
  /// std::ios_base::failure.
  explicit GridFile(const std::string& path);

  /// Returns the grid of floats with that name. An empty name stands for the only grid of floats.
  openvdb::FloatGrid::Ptr read(const std::string& name);

 private:
  const openvdb::io::GridDescriptor& find(const std::string& name) const;
  /// Returns the end of a message, with the names and types of the grids.
  std::string list() const;

  // The stream refers to this member.
  openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
  std::ifstream stream_;
  std::vector<openvdb::io::GridDescriptor> grids_;
};

}  // namespace snowshed
