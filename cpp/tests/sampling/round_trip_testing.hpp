// Snow of known volume that is converted to a solid and to particles again.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/sampling/particle_voxels.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::round_trip {

inline constexpr double voxel = 0.01;

struct Snow {
  const char* name;
  int dimension;
  geometry::Shape solid;
  double height, volume;
};

/// Returns a dome cut from a ball (in 2D from a disc). Its height is a quarter of its length.
inline Snow dome(int dimension) {
  const double height = dimension == 2 ? 0.1 : 0.06, radius = 2.5 * height;
  const geometry::Shape ball = geometry::make_sphere({0, 0, height - radius}, radius);
  const double half = std::sqrt(radius * radius - (radius - height) * (radius - height));
  const double section =
      radius * radius * std::acos(1 - height / radius) - (radius - height) * half;
  const double cap = pi * height * height * (radius - height / 3);
  return {"dome", dimension, geometry::subtract(ball, {geometry::make_plane({0, 0, 0}, {0, 0, 1})}),
          height, dimension == 2 ? section : cap};
}

/// Returns a slab, which has sharp edges.
inline Snow slab(int dimension) {
  const double height = 0.05, length = dimension == 2 ? 0.3 : 0.15, width = 0.1;
  return {"slab", dimension,
          geometry::make_box({0, 0, height / 2}, {length, dimension == 2 ? 1e9 : width, height}),
          height, height * length * (dimension == 2 ? 1 : width)};
}

inline double per_voxel(int dimension) { return dimension == 2 ? 6 : 8; }

inline std::vector<Vec3> particles_of(const geometry::LevelSet& solid, int dimension, int number) {
  return sampling::seed(solid, dimension, voxel, per_voxel(dimension),
                        sampling::SeedPattern::poisson, number);
}

inline double extent(const std::vector<Vec3>& cloud, int axis) {
  double low = 1e9, high = -1e9;
  for (const Vec3& x : cloud) {
    low = std::min(low, x[axis]);
    high = std::max(high, x[axis]);
  }
  return high - low;
}

inline double top(const std::vector<Vec3>& cloud) {
  double high = -1e9;
  for (const Vec3& x : cloud) high = std::max(high, x.z());
  return high;
}

/// Returns the height of the highest particle in each column of two voxels along x.
inline std::map<int, double> outline(const std::vector<Vec3>& cloud) {
  std::map<int, double> heights;
  for (const Vec3& x : cloud) {
    double& height = heights.try_emplace(int(std::floor(x.x() / (2 * voxel))), 0.0).first->second;
    height = std::max(height, x.z());
  }
  return heights;
}

/// Returns the root mean square difference of two outlines over the columns in which both have
/// snow.
inline double outline_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto outline_a = outline(a), outline_b = outline(b);
  double sum = 0, count = 0;
  for (const auto& [column, height] : outline_a) {
    const auto match = outline_b.find(column);
    if (match == outline_b.end()) continue;
    sum += std::pow(height - match->second, 2);
    ++count;
  }
  EXPECT_GT(count, 5);
  return std::sqrt(sum / count);
}

/// A conversion of particles to a solid, for example through a file.
using Solidify = std::function<geometry::Shape(const std::vector<Vec3>& particles, const Snow&)>;

/// Expects that volume, particle number and outline survive the conversion and seeding.
inline void expect_preserved(const Snow& snow, const Solidify& solidify) {
  SCOPED_TRACE(std::string(snow.name) + " in " + std::to_string(snow.dimension) + "D");
  const std::vector<Vec3> before = particles_of(*snow.solid, snow.dimension, 3);
  const geometry::Shape solid = solidify(before, snow);
  // The snow is smaller in 3D, where a tenth of a voxel all around is a larger part of it.
  const double tolerance = snow.dimension == 2 ? 0.02 : 0.05;
  EXPECT_NEAR(sampling::measure(*solid, snow.dimension, voxel) / snow.volume, 1, tolerance);
  const std::vector<Vec3> after = particles_of(*solid, snow.dimension, 4);
  EXPECT_NEAR(double(after.size()) / double(before.size()), 1, tolerance);
  EXPECT_NEAR(top(after), top(before), voxel / 2);
  EXPECT_NEAR(top(after), snow.height, voxel / 2);
  EXPECT_NEAR(extent(after, 0), extent(before, 0), voxel / 2);
  EXPECT_LT(outline_difference(before, after), voxel / 2);
}

}  // namespace snowshed::round_trip
