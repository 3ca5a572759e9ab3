// What a scene may choose of the material point method.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace snowshed::mpm {

enum class Precision { float32, float64 };
enum class Transfer { flip, apic };
enum class Basis { quadratic, cubic };

/// Settings of the material point method: grid, transfer, time step, sleep.
struct Settings {
  double dx = 0.01;  // m, grid and voxel size
  Precision precision = Precision::float32;
  Transfer transfer = Transfer::flip;
  double flip_ratio = 0.99;            // share of FLIP in each step; PIC has the rest and damps
  std::optional<double> damping_rate;  // 1/s, of PIC: in place of flip_ratio, whatever the step
  Basis basis = Basis::quadratic;
  double courant_factor = 0.9;  // time step over the largest stable one
  double strain_limit = 0.2;    // largest |dt grad v| a step may impose on a particle
  double sleep_speed = 0.02;    // m/s, snow slower than this drops out of the steps; 0: never
  double sleep_time = 0.04;     // s, for how long it must have been slower
  int threads = 0;              // 0: all

  /// The size of the smallest thing the method resolves, m.
  double resolution() const { return dx; }

  /// FLIP's share in a step of dt seconds. What the grid does not resolve keeps this part of its
  /// velocity, so that exp(-rate t) of it is left after a time t of steps of any length.
  double flip_share(double dt) const {
    return damping_rate ? std::exp(-*damping_rate * dt) : flip_ratio;
  }

  /// The mean rate (1/s) at which PIC damped over so many steps in so much time (s): -ln(share)/dt.
  /// Nothing for APIC, which has no such share, for pure PIC, which leaves nothing, and before the
  /// first step.
  std::optional<double> mean_damping_rate(std::int64_t steps, double time) const {
    if (transfer != Transfer::flip) return std::nullopt;
    if (damping_rate) return damping_rate;
    if (!(flip_ratio > 0) || steps == 0 || !(time > 0)) return std::nullopt;
    return std::abs(std::log(flip_ratio)) * double(steps) / time;
  }
};

}  // namespace snowshed::mpm
