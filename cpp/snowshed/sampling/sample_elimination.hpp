// Blue noise: points that keep their distance.
#pragma once

#include <cstddef>
#include <vector>

#include "snowshed/core/vec.hpp"

namespace snowshed {

/// Random points in and around a solid.
struct Candidates {
  std::vector<Vec3> points;
  std::vector<char> inside;  // whether points[i] lies in the solid
  std::size_t inside_count = 0;

  void add(const Vec3& point, bool in) {
    points.push_back(point);
    inside.push_back(in);
    inside_count += in;
  }
};

/// Weighted sample elimination (Yuksel 2015, "Sample elimination for generating Poisson disk
/// sample sets"): removes the most crowded candidate, over and over, until `count` of those
/// inside are left, and returns these. `point_measure` is the volume (area in 2D) per point.
///
/// Candidates outside take part so that the surface is not special: without them points on it
/// have fewer neighbours, survive more often, and the surface layer grows too dense.
///
/// Weights are integers, so that sums and differences are exact and the order of removal does
/// not hang on rounding. Time grows as N log N. `count` <= candidates.inside_count.
std::vector<Vec3> eliminate_samples(const Candidates& candidates, std::size_t count, int dimension,
                                    double point_measure);

}  // namespace snowshed
