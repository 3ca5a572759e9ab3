// Voxels of solids: cubes in 3D, squares of the plane y = 0 in 2D.
#pragma once

#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/level_set.hpp"

namespace snowshed::sampling {

/// A voxel that may hold points of a solid.
struct Voxel {
  Vec3 center;
  bool inside;  // no point of the voxel lies outside the solid
};

/// Returns the voxels with edge `edge` (metres) that may hold points within `margin` of the bounded
/// solid `shape`. Neighbouring voxels are near each other in the result. The lattice has a corner
/// `shift` (m) from the centre of the solid's bounds.
///
/// Throws InputError if the solid is unbounded or needs more than 2e8 voxels on its boundary, and
/// Stopped on request.
std::vector<Voxel> voxelize(const geometry::LevelSet& shape, int dimension, double edge,
                            double margin = 0.0, const StopRequest& stop = {},
                            const Vec3& shift = Vec3::Zero());

/// Returns which part of each voxel lies within the solid, 0 to 1, with the error of `measure`.
/// `voxels` are those that `voxelize` found for an edge. Throws Stopped on request.
std::vector<double> shares_within(const geometry::LevelSet& shape, int dimension, double edge,
                                  const std::vector<Voxel>& voxels, const StopRequest& stop = {});

/// Returns `shape` as a box if it is one. In 2D this is the rectangle in which the box cuts the
/// plane y = 0, with edges along columns 0 and 2 of `axes`; the box's own y axis must be normal to
/// the plane.
std::optional<geometry::OrientedBox> scene_box(const geometry::LevelSet& shape, int dimension);

/// Returns the volume (3D, m3) or area (2D, m2) of a bounded solid. It is exact for boxes in any
/// orientation. For other solids, voxels on the boundary are subdivided and cut by the tangent
/// plane, with an error of second order in the voxel size. Throws as `voxelize` does.
double measure(const geometry::LevelSet& shape, int dimension, double voxel,
               const StopRequest& stop = {});

}  // namespace snowshed::sampling
