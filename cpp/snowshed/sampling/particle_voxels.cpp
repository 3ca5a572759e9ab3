// 1. The union of dilated balls is, at every grid node, the distance to the nearest particle minus
//    radius + closing.
// 2. The zero crossings of this distance on the grid edges sample the dilated surface.
// 3. The distance to these crossings, shifted by `closing`, erodes the dilated union again.
//    Shifting the first distance instead would only shrink the balls and open the gaps again.
// 4. An isolated particle is too small for the grid to resolve. It gets a ball that is large
//    enough.
// All distances are those of NearestSeed.
#include "snowshed/sampling/particle_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/nearest_seed.hpp"

namespace snowshed::sampling {
namespace {

constexpr double max_nodes = 1.5e8;  // 1.2 GB while converting, 0.6 GB after

geometry::Bounds bounds_of(const std::vector<Vec3>& points, int dimension) {
  geometry::Bounds bounds = geometry::empty_bounds();
  for (const Vec3& x : points) {
    if (!x.allFinite()) throw InputError("", "a particle position is not finite");
    bounds = geometry::united_bounds(bounds, {x, x});
  }
  if (dimension == 2) bounds.min.y() = bounds.max.y() = 0;
  return bounds;
}

/// Returns a grid that covers the cloud and a margin; its values are not yet set.
geometry::GridSamples make_grid(const geometry::Bounds& bounds, int dimension, double spacing,
                                double margin) {
  geometry::GridSamples grid;
  grid.origin = bounds.min.array() - margin;
  grid.spacing = spacing;
  double total = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = bounds.max[axis] - bounds.min[axis] + 2 * margin;
    const double count = axis == 1 && dimension == 2 ? 1 : std::ceil(size / spacing) + 1;
    total *= count;
    if (total > max_nodes)
      throw InputError("",
                       "the cloud of particles spreads over more than 1.5e8 grid nodes; "
                       "choose a larger voxel size or remove the particles far from the rest");
    grid.counts[axis] = static_cast<std::size_t>(count);
  }
  if (dimension == 2) grid.origin.y() = 0;
  return grid;
}

/// Returns the number of nodes inside the solid among those within two to three spacings of x along
/// each axis.
int count_inside(const geometry::GridSamples& grid, const geometry::NearestSeed& nodes,
                 const Vec3& x) {
  const geometry::NearestSeed::Index low = nodes.cell_of(x);
  int inside = 0;
  for (std::int64_t i = low.i - 2; i <= low.i + 3; ++i)
    for (std::int64_t j = low.j - 2; j <= low.j + 3; ++j)
      for (std::int64_t k = low.k - 2; k <= low.k + 3; ++k)
        if (nodes.contains({i, j, k})) inside += grid.values[nodes.at({i, j, k})] < 0;
  return inside;
}

/// Unites the solid with a ball around each isolated particle, which is one with less than a voxel
/// of solid around it. The ball is large enough for the grid to resolve.
void keep_isolated_particles(geometry::GridSamples& grid, geometry::NearestSeed& nodes,
                             const std::vector<Vec3>& points, int dimension) {
  std::vector<Vec3> isolated;
  for (const Vec3& x : points)
    if (count_inside(grid, nodes, x) < (dimension == 2 ? 4 : 8)) isolated.push_back(x);
  if (isolated.empty()) return;
  // Seeding places no particle in a smaller ball.
  const double radius = (dimension == 2 ? 1.0 : 1.15) * grid.spacing;
  nodes.propagate(isolated);
  nodes.for_each_node([&](const geometry::NearestSeed::Index& n) {
    float& value = grid.values[nodes.at(n)];
    value = std::min(value, static_cast<float>(nodes.distance(n) - radius));
  });
}

void check_arguments(const std::vector<Vec3>& points, double voxel, double radius) {
  if (points.empty()) throw InputError("", "no particles to make a solid of");
  if (!(voxel > 0) || !std::isfinite(voxel))
    throw InputError("voxel size", std::to_string(voxel) + "; must be positive, in m");
  if (!(radius > 0) || !std::isfinite(radius))
    throw InputError("particle radius", std::to_string(radius) + "; must be positive, in m");
}

}  // namespace

double particle_radius(int dimension, double voxel, double per_voxel) {
  return 0.375 * voxel / (dimension == 2 ? std::sqrt(per_voxel) : std::cbrt(per_voxel));
}

geometry::GridSamples particles_to_samples(const std::vector<Vec3>& points, int dimension,
                                           double voxel, double radius) {
  check_arguments(points, voxel, radius);
  const double spacing = voxel / 2, closing = voxel;
  geometry::GridSamples grid =
      make_grid(bounds_of(points, dimension), dimension, spacing, radius + closing + 2 * spacing);

  geometry::NearestSeed nodes(grid.origin, spacing, grid.counts);
  nodes.propagate(points);
  grid.values.resize(grid.counts[0] * grid.counts[1] * grid.counts[2]);
  nodes.for_each_node([&](const geometry::NearestSeed::Index& n) {
    grid.values[nodes.at(n)] = static_cast<float>(nodes.distance(n) - radius - closing);
  });

  const std::vector<Vec3> surface = geometry::zero_crossings(nodes, grid.values);
  nodes.propagate(surface);
  nodes.for_each_node([&](const geometry::NearestSeed::Index& n) {
    float& value = grid.values[nodes.at(n)];
    value = static_cast<float>(std::copysign(nodes.distance(n), value) + closing);
  });
  keep_isolated_particles(grid, nodes, points, dimension);
  return grid;
}

geometry::Shape particles_to_level_set(const std::vector<Vec3>& points, int dimension, double voxel,
                                       double radius) {
  return geometry::make_sampled_grid(particles_to_samples(points, dimension, voxel, radius),
                                     "particles");
}

}  // namespace snowshed::sampling
