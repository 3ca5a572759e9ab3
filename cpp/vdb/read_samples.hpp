// The samples of a grid of an OpenVDB file.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/readers/vdb_message.hpp"

namespace snowshed {

struct VdbSamples {
  geometry::VdbHeader header;
  std::vector<float> values;
};

/// Returns the samples of a level set or a fog volume in the box around its active voxels, one
/// voxel wider on every side. Throws InputError, openvdb::Exception or std::ios_base::failure.
VdbSamples read_samples(const std::string& path, const std::string& grid);

}  // namespace snowshed
