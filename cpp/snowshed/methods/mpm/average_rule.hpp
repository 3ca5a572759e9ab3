// The steps in which velocities are damped towards their averages over a length, and how much. A
// graphics card compiles this file, too.
#pragma once

#include <cmath>

namespace snowshed::methods::mpm {

/// Number of steps from one damping to the next; each damping stands for all of them. Little
/// changes between them, because snow moves by a fraction of a cell per step, and an average costs
/// a third of a step.
inline constexpr int steps_between_averages = 4;

/// Whether the next step damps velocities, after this number of steps since the last damping.
inline bool damps_after(long long undamped_steps) {
  return undamped_steps + 1 >= steps_between_averages;
}

/// The share of the difference from the average that is lost at a rate (1/s) in a time (s).
inline double damped_share(double rate, double time) { return -std::expm1(-rate * time); }

}  // namespace snowshed::methods::mpm
