// Blue noise: random points that keep a distance from each other.
#pragma once

#include <cstddef>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::sampling {

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
/// sample sets"). Removes the candidate with the largest weight until `count` of those inside are
/// left, and returns these. `point_measure` is the volume (area in 2D) per point. `count` must not
/// exceed candidates.inside_count.
///
/// Candidates outside the solid are eliminated, too. Without them, points at the surface would have
/// fewer neighbours and be removed less often, and the surface layer would become too dense.
///
/// Weights are integers. Their sums and differences are exact, so the order of removal does not
/// depend on rounding. The time grows as N log N. Throws Stopped on request.
std::vector<Vec3> eliminate_samples(const Candidates& candidates, std::size_t count, int dimension,
                                    double point_measure, const StopRequest& stop = {});

}  // namespace snowshed::sampling
