#include "snowshed/sampling/seeding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/random.hpp"
#include "snowshed/sampling/sample_elimination.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::sampling {
namespace {

[[noreturn]] void fail(const std::string& where, double value, const std::string& allowed) {
  std::ostringstream what;
  what << value << "; " << allowed;
  throw InputError(where, what.str());
}

void check_arguments(int dimension, double voxel, double per_voxel) {
  if (dimension != 2 && dimension != 3) fail("dimension", dimension, "allowed: 2 or 3");
  if (!(voxel > 0) || !std::isfinite(voxel)) fail("voxel size", voxel, "must be positive, in m");
  if (!(per_voxel > 0 && per_voxel <= 1000))
    fail("particles per voxel", per_voxel, "must be greater than 0 and at most 1000");
}

/// Returns `count` rounded up. An excess that is only rounding is ignored.
double round_up(double count) { return std::ceil(count * (1 - 1e-9)); }

/// Returns the mean spacing of particles.
double spacing(int dimension, double voxel, double per_voxel) {
  return voxel / (dimension == 2 ? std::sqrt(per_voxel) : std::cbrt(per_voxel));
}

double count_for(double measure, int dimension, double voxel, double per_voxel) {
  const double count = round_up(per_voxel * measure / std::pow(voxel, dimension));
  if (count < 1) throw InputError("", "the solid to fill with particles is empty");
  if (count > max_particles)
    fail("particles to fill the solid", count, "at most 2e8 are possible: choose a larger dx");
  return count;
}

/// A box cut into equal cells no larger than the spacing.
struct Tiling {
  geometry::OrientedBox box;
  std::array<std::size_t, 3> counts{1, 1, 1};
  Mat3 cell = Mat3::Zero();  // columns: the edges of a cell

  Tiling(const geometry::OrientedBox& box, int dimension, double spacing) : box(box) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == 1 && dimension == 2) continue;
      const double length = 2 * box.half[axis];
      counts[axis] = static_cast<std::size_t>(std::max(1.0, round_up(length / spacing)));
      cell.col(axis) = box.axes.col(axis) * (length / counts[axis]);
    }
  }

  std::size_t size() const { return counts[0] * counts[1] * counts[2]; }

  Vec3 center(std::size_t i, std::size_t j, std::size_t k) const {
    const Vec3 steps(i - (counts[0] - 1) / 2.0, j - (counts[1] - 1) / 2.0,
                     k - (counts[2] - 1) / 2.0);
    return box.center + cell * steps;
  }
};

/// Places a point in each lattice cell: its centre, or a random point if `random` is given.
class LatticeSeeder {
 public:
  LatticeSeeder(const geometry::LevelSet& shape, Random* random, const StopRequest& stop)
      : shape_(shape), random_(random), check_stop_(stop) {}

  /// Returns one point for every cell of the tiling.
  std::vector<Vec3> fill(const Tiling& tiling) {
    std::vector<Vec3> points;
    points.reserve(tiling.size());
    for (std::size_t i = 0; i < tiling.counts[0]; ++i)
      for (std::size_t j = 0; j < tiling.counts[1]; ++j)
        for (std::size_t k = 0; k < tiling.counts[2]; ++k) {
          const Vec3 center = tiling.center(i, j, k), x = center + offset(tiling.cell);
          // Due to rounding, a random point of an outer cell may lie on the surface.
          points.push_back(shape_.distance(x) < 0 ? x : center);
        }
    return points;
  }

  /// Returns a point for every cell whose point lies inside the solid.
  std::vector<Vec3> fill(const std::vector<Voxel>& cells, const Mat3& cell) {
    std::vector<Vec3> points;
    for (const Voxel& voxel : cells) {
      const Vec3 x = voxel.center + offset(cell);
      if (voxel.inside || shape_.distance(x) < 0) points.push_back(x);
    }
    return points;
  }

 private:
  Vec3 offset(const Mat3& cell) {
    check_stop_();
    if (!random_) return Vec3::Zero();
    const double a = random_->uniform(), b = random_->uniform(), c = random_->uniform();
    return cell * Vec3(a - 0.5, b - 0.5, c - 0.5);
  }

  const geometry::LevelSet& shape_;
  Random* random_;
  StopCheck check_stop_;
};

std::vector<Vec3> seed_lattice(const geometry::LevelSet& shape, int dimension, double spacing,
                               Random* random, const StopRequest& stop) {
  LatticeSeeder seeder(shape, random, stop);
  if (const auto box = scene_box(shape, dimension))
    return seeder.fill(Tiling(*box, dimension, spacing));
  Mat3 cell = spacing * Mat3::Identity();
  if (dimension == 2) cell(1, 1) = 0;
  return seeder.fill(voxelize(shape, dimension, spacing, 0.0, stop), cell);
}

/// Returns random candidates inside the solid and within `margin` of it, on average `per_voxel` in
/// each voxel. At least `wanted` of them are inside.
Candidates draw_candidates(const geometry::LevelSet& shape, int dimension, double voxel,
                           double per_voxel, double margin, std::size_t wanted, Random& random,
                           const StopRequest& stop) {
  constexpr int max_rounds = 1000;
  const std::vector<Voxel> voxels = voxelize(shape, dimension, voxel, margin, stop);
  StopCheck check_stop(stop);
  Candidates candidates;
  for (int round = 0; round < max_rounds && candidates.inside_count < wanted; ++round)
    for (const Voxel& v : voxels) {
      check_stop();
      const int count = static_cast<int>(per_voxel + random.uniform());
      for (int n = 0; n < count; ++n) {
        const double a = random.uniform(), b = random.uniform(), c = random.uniform();
        const Vec3 offset(a - 0.5, dimension == 2 ? 0.0 : b - 0.5, c - 0.5);
        const Vec3 x = v.center + voxel * offset;
        const double d = v.inside ? -1 : shape.distance(x);
        if (d < margin) candidates.add(x, d < 0);
      }
    }
  if (candidates.inside_count < wanted)
    throw InputError("", "the solid is too thin for the voxel size to be filled with particles");
  return candidates;
}

std::vector<Vec3> seed_poisson(const geometry::LevelSet& shape, int dimension, double voxel,
                               double per_voxel, Random& random, const StopRequest& stop) {
  constexpr std::size_t candidates_per_point = 3;  // Yuksel: 5 gains little over 3
  const double total = measure(shape, dimension, voxel, stop);
  const auto count = static_cast<std::size_t>(count_for(total, dimension, voxel, per_voxel));
  // The reach of the pair weights, but no more than the solid itself is thick.
  const double margin =
      std::min(1.2 * spacing(dimension, voxel, per_voxel), std::max(shape.inradius(), 0.0));
  const Candidates candidates =
      draw_candidates(shape, dimension, voxel, candidates_per_point * per_voxel, margin,
                      candidates_per_point / 2 * count, random, stop);
  return eliminate_samples(candidates, count, dimension, total / count, stop);
}

}  // namespace

std::vector<Vec3> seed(const geometry::LevelSet& shape, int dimension, double voxel,
                       double per_voxel, SeedPattern pattern, std::uint64_t seed,
                       const StopRequest& stop) {
  // Checks the arguments and refuses excessive counts before anything is allocated.
  expected_count(shape, dimension, voxel, per_voxel, pattern);
  Random random(seed);
  if (pattern == SeedPattern::poisson)
    return seed_poisson(shape, dimension, voxel, per_voxel, random, stop);
  std::vector<Vec3> points =
      seed_lattice(shape, dimension, spacing(dimension, voxel, per_voxel),
                   pattern == SeedPattern::jittered ? &random : nullptr, stop);
  if (points.empty())
    throw InputError("", "the solid is too small for the voxel size to hold a particle");
  return points;
}

std::size_t expected_count(const geometry::LevelSet& shape, int dimension, double voxel,
                           double per_voxel, SeedPattern pattern) {
  check_arguments(dimension, voxel, per_voxel);
  const double count = count_for(measure(shape, dimension, voxel), dimension, voxel, per_voxel);
  const auto box = scene_box(shape, dimension);
  if (pattern == SeedPattern::poisson || !box) return static_cast<std::size_t>(count);
  return Tiling(*box, dimension, spacing(dimension, voxel, per_voxel)).size();
}

}  // namespace snowshed::sampling
