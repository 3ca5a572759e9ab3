// Lengths of the steps, and what depends on them. A graphics card compiles this file, too.
#pragma once

#include <cmath>

namespace snowshed::methods::mpm {

/// The time step to take: the elastic limit shortened so that the fastest particle moves no more
/// than half a cell. `factor` in (0, 1].
inline double next_time_step(double elastic_limit, double speed, double dx, double factor) {
  return factor / (1 / elastic_limit + 2 * speed / dx);
}

/// The time step to try after one of dt that would strain a particle beyond the limit.
inline double shortened_time_step(double dt, double strain, double limit) {
  const double share = 0.8 * limit / strain;
  return dt * (share < 0.5 ? share : 0.5);
}

/// The smallest time step over the elastic limit. Shorter ones mean that something is broken.
inline constexpr double min_step_share = 1e-7;

}  // namespace snowshed::methods::mpm
