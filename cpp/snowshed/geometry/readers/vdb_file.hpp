// Solids from OpenVDB files.
#pragma once

#include <filesystem>
#include <string>

#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed::geometry {

/// A grid of a file, and the meaning of its values.
struct VdbSource {
  std::filesystem::path path;
  std::string grid;        // the name of the grid; empty: the only grid of floats
  double threshold = 0.5;  // fog volumes: values above it are solid
  double scale = 1.0;      // metres per unit of the file
};

/// Returns signed distances in metres on the box around the grid's active voxels. Those of a level
/// set are taken from the file within its narrow band and rebuilt outside it. Those of a fog volume
/// are distances to the surface on which its value is the threshold.
///
/// OpenVDB crashes on damaged files. The program snowshed-vdb therefore reads them, in a process
/// with limits on memory and time.
///
/// Throws InputError with the file and the grid if the grid cannot be read, is not a level set or
/// fog volume of floats, has voxels that are not cubes along the axes, or has a box of more than
/// `max_vdb_samples`; and if snowshed was built without OpenVDB.
GridSamples read_vdb(const VdbSource& source);

}  // namespace snowshed::geometry
