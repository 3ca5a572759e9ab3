// The course of a step, decided on the device: its length, whether it must be shorter, its end.
#pragma once

#include "snowshed/methods/mpm/average_rule.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/step_length.hpp"

namespace snowshed::methods::mpm::gpu {

/// A whole number that is in the same order as other numbers' whole numbers.
__device__ inline std::int32_t ordered(float x) {
  const std::int32_t bits = __float_as_int(x);
  return bits ^ (bits >> 31 & 0x7fffffff);
}
__device__ inline float from_ordered(std::int32_t bits) {
  return __int_as_float(bits ^ (bits >> 31 & 0x7fffffff));
}

/// Returns a power of two that is at least x > 0.
__device__ inline float power_of_two_above(float x) {
  int exponent;
  ::frexpf(x, &exponent);
  return ::ldexpf(1.0f, exponent);
}

/// The sums of a tile have two parts of 32 bits: 2^16 high + low. A particle's part of a sum is
/// less than 2^unit_bits units, so that the 256 particles of a tile fill 2^46.
inline constexpr int unit_bits = 38;

/// Returns the unit of the momentum of particles that a step moves. A particle's velocity becomes a
/// mean of node velocities, and of its velocity before plus a mean of the nodes' changes. The nodes
/// had the velocities of particles and their affine velocities times an arm. (With its weight, the
/// new affine velocity adds less than the fastest node.)
__device__ inline float momentum_unit(const Control& c, const Constants& k) {
  float fastest = 0;
  for (int d = 0; d < 3; ++d)
    fastest = ::fmaxf(fastest, ::fmaxf(-from_ordered(c.low[d]), from_ordered(c.high[d])));
  const float bound = 2 * (::sqrtf(c.speed_squared) + fastest) + arm * c.spin * float(k.dx);
  return k.mass_unit * power_of_two_above(::fminf(::fmaxf(bound, 1e-12f), 1e12f));
}

/// Returns a bound of the velocity gradients, 1/s, from the range of the node velocities.
__device__ inline double bound_from_range(const float (&low)[3], const float (&high)[3],
                                          double dx) {
  double range = 0;
  for (int d = 0; d < 3; ++d) {
    const double of_component = double(high[d]) - double(low[d]);
    if (!(of_component <= range) && range == range) range = of_component;  // NaN stays
  }
  return range / dx;
}
__device__ inline double bound_of_all(const Control& c, double dx) {
  float low[3], high[3];
  for (int d = 0; d < 3; ++d) {
    low[d] = from_ordered(c.low[d]);
    high[d] = from_ordered(c.high[d]);
  }
  return bound_from_range(low, high, dx);
}

/// Velocity gradients up to this one, 1/s, shorten no step.
__device__ inline double harmless_gradient(const Constants& k) {
  return k.strain_limit / next_time_step(k.elastic_limit, 0.0, k.dx, k.courant_factor);
}

__device__ inline void clear_range(Control& c) {
  for (int d = 0; d < 3; ++d) {
    c.low[d] = ordered(3e38f);
    c.high[d] = ordered(-3e38f);
  }
  c.strain = 0;
}

/// The speed of the fastest snow in the last step, m/s.
__device__ inline double largest_speed(const Control& c) {
  return double(::sqrtf(c.speed_squared));
}

/// Records a step that was taken.
__device__ inline void record_step(Control& c, const Constants& k) {
  if (k.average_share > 0) count_undamped(c.undamped_steps, c.undamped_time, c.dt);
  c.time += c.dt;
  c.travel += largest_speed(c) * c.dt;
  c.last_dt = c.dt;
  c.smallest_dt = c.dt < c.smallest_dt ? c.dt : c.smallest_dt;
  ++c.steps;
  --c.steps_left;
  ++c.taken;
  c.strays = 0;
  c.phase = c.unsound != no_particle ? Phase::unsound : Phase::waiting;
}

/// Begins the next step, or the shorter one.
__device__ inline void begin_step(Control& c, const Constants& k) {
  if (c.phase == Phase::too_long) {
    c.repeated = 1;
  } else {
    if (!(c.time < c.until) || c.steps_left <= 0 || c.must_sort || c.travel >= c.travel_limit)
      return;
    c.repeated = 0;
    c.dt = next_time_step(k.elastic_limit, largest_speed(c), k.dx, k.courant_factor);
  }
  clear_range(c);
  c.phase = Phase::trying;
}

/// Accepts the step being tried, or shortens it.
__device__ inline void judge(Control& c, const Constants& k) {
  double gradient = bound_of_all(c, k.dx);
  if (!(gradient <= harmless_gradient(k))) gradient = double(c.strain);
  const double strain = gradient * c.dt;
  if (strain <= k.strain_limit) {
    c.momentum_unit = momentum_unit(c, k);
    c.speed_squared = 0;
    c.spin = 0;
    c.phase = Phase::accepted;
    return;
  }
  ++c.rejected;
  c.strain_of_step = float(strain);
  c.dt = strain < 1e30 ? shortened_time_step(c.dt, strain, k.strain_limit) : 0.0;
  c.phase = c.dt > min_step_share * k.elastic_limit ? Phase::too_long : Phase::stuck;
}

}  // namespace snowshed::methods::mpm::gpu

/// Ends a step and begins the next.
extern "C" __global__ void next_step(snowshed::methods::mpm::gpu::Control* control,
                                     snowshed::methods::mpm::gpu::Constants constants) {
  using namespace snowshed::methods::mpm::gpu;
  if (control->phase == Phase::accepted) record_step(*control, constants);
  if (control->phase == Phase::waiting || control->phase == Phase::too_long)
    begin_step(*control, constants);
}

extern "C" __global__ void judge_step(snowshed::methods::mpm::gpu::Control* control,
                                      snowshed::methods::mpm::gpu::Constants constants) {
  using namespace snowshed::methods::mpm::gpu;
  if (control->phase == Phase::trying) judge(*control, constants);
}
