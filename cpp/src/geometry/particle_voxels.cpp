// 1. The distance to the nearest particle at every grid node, less radius + closing, is the
//    union of dilated balls.
// 2. Its zero crossings on the grid edges sample the dilated surface.
// 3. The distance to these, shifted by `closing`, erodes the dilated union again. Shifting the
//    first distance instead would only make the balls smaller and open the gaps once more.
// Both distances come from sweeping the nearest seed point over the grid.
#include "snowshed/geometry/particle_voxels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/sampled_grid.hpp"
#include "snowshed/support/error.hpp"

namespace snowshed {
namespace {

constexpr double max_nodes = 1.5e8;  // 1.2 GB while converting, 0.6 GB after

struct Index {
  std::int64_t i, j, k;
};

/// The nodes of the grid, and the nearest of a set of seed points at each (Danielsson 1980,
/// "Euclidean distance mapping"): sweeps in all directions hand seeds on from node to node.
class NearestSeed {
 public:
  NearestSeed(const Vec3& origin, double spacing, const std::array<std::size_t, 3>& counts)
      : origin_(origin),
        spacing_(spacing),
        counts_{std::int64_t(counts[0]), std::int64_t(counts[1]), std::int64_t(counts[2])},
        nearest_(counts[0] * counts[1] * counts[2], none) {}

  std::size_t at(const Index& n) const {
    return static_cast<std::size_t>((n.i * counts_[1] + n.j) * counts_[2] + n.k);
  }
  Vec3 position(const Index& n) const { return origin_ + spacing_ * Vec3(n.i, n.j, n.k); }
  bool contains(const Index& n) const {
    return n.i >= 0 && n.j >= 0 && n.k >= 0 && n.i < counts_[0] && n.j < counts_[1] &&
           n.k < counts_[2];
  }

  template <class Visit>
  void for_each_node(Visit visit) const {
    for (std::int64_t i = 0; i < counts_[0]; ++i)
      for (std::int64_t j = 0; j < counts_[1]; ++j)
        for (std::int64_t k = 0; k < counts_[2]; ++k) visit(Index{i, j, k});
  }

  /// Offers the seeds to the corners of their cells and sweeps them over the grid.
  void spread(const std::vector<Vec3>& seeds) {
    seeds_ = &seeds;
    for (std::uint32_t s = 0; s < seeds.size(); ++s) offer_to_cell(s);
    for (int sweep = 0; sweep < 8; ++sweep)
      this->sweep(sweep & 1 ? -1 : 1, sweep & 2 ? -1 : 1, sweep & 4 ? -1 : 1);
  }

  double distance(const Index& n) const {
    return ((*seeds_)[nearest_[at(n)]] - position(n)).norm();
  }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;

  void offer(const Index& n, std::uint32_t seed) {
    std::uint32_t& nearest = nearest_[at(n)];
    if (seed == none || seed == nearest) return;
    const Vec3 x = position(n);
    if (nearest == none ||
        ((*seeds_)[seed] - x).squaredNorm() < ((*seeds_)[nearest] - x).squaredNorm())
      nearest = seed;
  }

  void offer_to_cell(std::uint32_t seed) {
    const Vec3 u = ((*seeds_)[seed] - origin_) / spacing_;
    for (int corner = 0; corner < 8; ++corner) {
      const Index n{std::int64_t(std::floor(u.x())) + (corner & 1),
                    std::int64_t(std::floor(u.y())) + (corner >> 1 & 1),
                    std::int64_t(std::floor(u.z())) + (corner >> 2 & 1)};
      if (contains(n)) offer(n, seed);
    }
  }

  /// Visits every node after its neighbours on the side the sweep comes from.
  void sweep(int di, int dj, int dk) {
    const auto start = [](int d, std::int64_t n) { return d > 0 ? 0 : n - 1; };
    Index n;
    for (n.i = start(di, counts_[0]); n.i >= 0 && n.i < counts_[0]; n.i += di)
      for (n.j = start(dj, counts_[1]); n.j >= 0 && n.j < counts_[1]; n.j += dj)
        for (n.k = start(dk, counts_[2]); n.k >= 0 && n.k < counts_[2]; n.k += dk)
          for (const Index& from :
               {Index{n.i - di, n.j, n.k}, {n.i, n.j - dj, n.k}, {n.i, n.j, n.k - dk}})
            if (contains(from)) offer(n, nearest_[at(from)]);
  }

  Vec3 origin_;
  double spacing_;
  std::array<std::int64_t, 3> counts_;
  std::vector<std::uint32_t> nearest_;
  const std::vector<Vec3>* seeds_ = nullptr;
};

Bounds bounds_of(const std::vector<Vec3>& points, int dimension) {
  Bounds bounds = no_bounds();
  for (const Vec3& x : points) {
    if (!x.allFinite()) throw InputError("", "a particle position is not finite");
    bounds = unite(bounds, {x, x});
  }
  if (dimension == 2) bounds.min.y() = bounds.max.y() = 0;
  return bounds;
}

/// A grid of the given spacing over the cloud and a margin, without its values.
GridSamples make_grid(const Bounds& bounds, int dimension, double spacing, double margin) {
  GridSamples grid;
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
                       "choose a larger voxel size or drop the outliers");
    grid.counts[axis] = static_cast<std::size_t>(count);
  }
  if (dimension == 2) grid.origin.y() = 0;
  return grid;
}

/// Where `values` changes sign along the grid's edges, by linear interpolation.
std::vector<Vec3> zero_crossings(const NearestSeed& grid, const std::vector<float>& values) {
  std::vector<Vec3> crossings;
  grid.for_each_node([&](const Index& n) {
    const double a = values[grid.at(n)];
    for (const Index& next : {Index{n.i + 1, n.j, n.k}, {n.i, n.j + 1, n.k}, {n.i, n.j, n.k + 1}}) {
      if (!grid.contains(next)) continue;
      const double b = values[grid.at(next)];
      if ((a < 0) == (b < 0)) continue;
      const Vec3 from = grid.position(n), to = grid.position(next);
      crossings.push_back(from + a / (a - b) * (to - from));
    }
  });
  return crossings;
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

Shape particles_to_level_set(const std::vector<Vec3>& points, int dimension, double voxel,
                             double radius) {
  check_arguments(points, voxel, radius);
  const double spacing = voxel / 2, closing = voxel;
  GridSamples grid =
      make_grid(bounds_of(points, dimension), dimension, spacing, radius + closing + 2 * spacing);

  NearestSeed to_particles(grid.origin, spacing, grid.counts);
  to_particles.spread(points);
  grid.values.resize(grid.counts[0] * grid.counts[1] * grid.counts[2]);
  to_particles.for_each_node([&](const Index& n) {
    grid.values[to_particles.at(n)] =
        static_cast<float>(to_particles.distance(n) - radius - closing);
  });

  const std::vector<Vec3> surface = zero_crossings(to_particles, grid.values);
  NearestSeed to_surface(grid.origin, spacing, grid.counts);
  to_surface.spread(surface);
  to_surface.for_each_node([&](const Index& n) {
    float& value = grid.values[to_surface.at(n)];
    value = static_cast<float>(std::copysign(to_surface.distance(n), value) + closing);
  });
  if (*std::min_element(grid.values.begin(), grid.values.end()) >= 0)
    throw InputError("", "only isolated particles, smaller than the grid can show");
  return make_sampled_grid(std::move(grid), "particles");
}

}  // namespace snowshed
