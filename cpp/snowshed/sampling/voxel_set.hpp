// Solids cut into voxels: cubes in 3D, squares of the plane y = 0 in 2D.
#pragma once

#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// A voxel of a solid. `inside`: no point of it lies outside the solid.
struct Voxel {
  Vec3 center;
  bool inside;
};

/// The voxels with edge `edge` (metres) that may hold points within `margin` of the bounded
/// solid `shape`, in an order that keeps neighbours together. The lattice has a corner at
/// the centre of the solid's bounds.
///
/// Throws InputError if the solid is unbounded or needs an absurd number of voxels.
std::vector<Voxel> voxelize(const LevelSet& shape, int dimension, double edge, double margin = 0.0);

/// `shape` as a box, if it is one. In 2D: the rectangle it cuts from the plane y = 0, its edges
/// along the columns 0 and 2 of `axes`, if its own y axis is across the plane.
std::optional<OrientedBox> scene_box(const LevelSet& shape, int dimension);

/// Volume (3D, m3) or area (2D, m2) of a bounded solid. Exact for boxes in any orientation;
/// otherwise voxels on the boundary are subdivided and their parts cut off by the tangent
/// plane, an error of second order in the voxel size. Throws as `voxelize`.
double measure(const LevelSet& shape, int dimension, double voxel);

}  // namespace snowshed
