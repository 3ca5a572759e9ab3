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

/// Counts a step of dt (s) among the steps, and the time (s), since the last damping.
template <class Count>
void count_undamped(Count& undamped_steps, double& undamped_time, double dt) {
  const bool damped = damps_after(undamped_steps);
  undamped_steps = damped ? 0 : undamped_steps + 1;
  undamped_time = damped ? 0.0 : undamped_time + dt;
}

/// The share of the difference from the average that is lost at a rate (1/s) in a time (s).
inline double damped_share(double rate, double time) { return -std::expm1(-rate * time); }

}  // namespace snowshed::methods::mpm
