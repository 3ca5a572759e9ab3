#include "read_samples.hpp"

#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "grid_file.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

template <class... Values>
[[noreturn]] void fail(const Values&... values) {
  std::ostringstream text;
  (text << ... << values);
  throw InputError("", text.str());
}

geometry::VdbKind kind_of(const openvdb::FloatGrid& grid) {
  switch (grid.getGridClass()) {
    case openvdb::GRID_LEVEL_SET:
      return geometry::VdbKind::level_set;
    case openvdb::GRID_FOG_VOLUME:
      return geometry::VdbKind::fog_volume;
    default:
      fail("a grid of class '", openvdb::GridBase::gridClassToString(grid.getGridClass()),
           "'; allowed: level set, fog volume");
  }
}

/// Returns the edge of a voxel. Voxels must be cubes along the axes, as are those of snowshed.
double spacing_of(const openvdb::FloatGrid& grid) {
  const openvdb::math::Transform& to_world = grid.transform();
  if (!to_world.isLinear()) fail("its transform is not linear; resample it to uniform voxels");
  const openvdb::Vec3d origin = to_world.indexToWorld(openvdb::Vec3d(0));
  const double spacing = to_world.indexToWorld(openvdb::Vec3d(1, 0, 0)).x() - origin.x();
  if (!std::isfinite(spacing) || !(spacing > 0))
    fail("voxels of ", spacing, " along x; the size must be positive");
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d step(0.0);
    step[axis] = 1;
    const openvdb::Vec3d off = to_world.indexToWorld(step) - origin - spacing * step;
    if (!(off.length() <= 1e-6 * spacing))
      fail("its voxels are not cubes along the axes; resample it without rotation and stretching");
  }
  return spacing;
}

/// Returns the box around the active voxels, one voxel wider on every side.
openvdb::CoordBBox box_of(const openvdb::FloatGrid& grid) {
  openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) fail("it has no active voxels");
  double total = 1;
  for (int axis = 0; axis < 3; ++axis)
    total *= double(box.max()[axis]) - double(box.min()[axis]) + 3;
  if (total > double(geometry::max_vdb_samples))
    fail("the box around its ", grid.activeVoxelCount(), " active voxels holds ", total,
         " in all; at most ", double(geometry::max_vdb_samples), " are read");
  box.expand(1);
  return box;
}

/// Returns the width of the narrow band of a level set.
double band_of(const openvdb::FloatGrid& grid, double spacing) {
  const double band = grid.background();
  if (!(band >= spacing) || !std::isfinite(band))
    fail("a level set with the background ", band,
         "; the background is the width of the narrow band and must be"
         " one voxel (",
         spacing, ") or more");
  return band;
}

}  // namespace

VdbSamples read_samples(const std::string& path, const std::string& name) {
  const openvdb::FloatGrid::Ptr grid = GridFile(path).read(name);
  VdbSamples result;
  geometry::VdbHeader& header = result.header;
  header.kind = kind_of(*grid);
  header.spacing = spacing_of(*grid);
  if (header.kind == geometry::VdbKind::level_set)
    header.background = band_of(*grid, header.spacing);
  const openvdb::CoordBBox box = box_of(*grid);
  const openvdb::Vec3d origin = grid->indexToWorld(box.min());
  for (int axis = 0; axis < 3; ++axis) {
    header.origin[axis] = origin[axis];
    header.counts[axis] = std::uint64_t(box.dim()[axis]);
  }
  result.values.resize(box.volume());
  openvdb::tools::Dense<float, openvdb::tools::LayoutZYX> dense(box, result.values.data());
  openvdb::tools::copyToDense(*grid, dense, /*serial=*/true);
  const auto finite = [](float value) { return std::isfinite(value); };
  const auto bad = std::find_if_not(result.values.begin(), result.values.end(), finite);
  if (bad != result.values.end()) {
    const openvdb::Coord at = dense.offsetToCoord(std::size_t(bad - result.values.begin()));
    fail("the value at voxel ", at, " is not finite");
  }
  return result;
}

}  // namespace snowshed
