// A grid of an OpenVDB file as plain samples.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/readers/vdb_message.hpp"

namespace snowshed {

struct VdbSamples {
  VdbHeader header;
  std::vector<float> values;
};

/// The samples of a level set or a fog volume in the box around its active voxels, one voxel
/// wider. Throws InputError, openvdb::Exception or std::ios_base::failure.
VdbSamples read_samples(const std::string& path, const std::string& grid);

}  // namespace snowshed
