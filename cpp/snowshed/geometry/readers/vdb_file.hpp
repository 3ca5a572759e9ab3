// Solids from OpenVDB files.
#pragma once

#include <filesystem>
#include <string>

#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed {

/// Which grid of a file, and what its values mean.
struct VdbSource {
  std::filesystem::path path;
  std::string grid;        // its name; empty: the only one of floats
  double threshold = 0.5;  // of a fog volume: the solid is where the value is above it
  double scale = 1.0;      // metres per unit of the file
};

/// Signed distances in metres on the box of what the grid holds: those of a level set within its
/// narrow band, rebuilt beyond it; of a fog volume, distances to where it passes the threshold.
///
/// OpenVDB is no match for damaged files, so they are read by the program snowshed-vdb, in a
/// process with little memory and time.
///
/// Throws InputError naming the file and the grid if it cannot be read or is not of floats, of
/// these two classes, on a uniform lattice along the axes and at most `max_vdb_samples` large; or
/// if snowshed was built without OpenVDB.
GridSamples read_vdb(const VdbSource& source);

}  // namespace snowshed
