// The grids of one OpenVDB file that is not to be trusted.
#pragma once

#include <openvdb/openvdb.h>
// After the above, on which it depends.
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <fstream>
#include <string>
#include <vector>

namespace snowshed {

/// OpenVDB's own io::File takes a file that ends too early for one full of zeros; here the stream
/// throws std::ios_base::failure.
class GridFile : private openvdb::io::Archive {
 public:
  /// Reads what precedes the grids. Throws InputError, openvdb::Exception or
  /// std::ios_base::failure.
  explicit GridFile(const std::string& path);

  /// The grid of floats with that name; with an empty one, the only grid of floats.
  openvdb::FloatGrid::Ptr read(const std::string& name);

 private:
  const openvdb::io::GridDescriptor& find(const std::string& name) const;
  std::string list() const;

  // The stream keeps a pointer to this pointer.
  openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
  std::ifstream stream_;
  std::vector<openvdb::io::GridDescriptor> grids_;
};

}  // namespace snowshed
