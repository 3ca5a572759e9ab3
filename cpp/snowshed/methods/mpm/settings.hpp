// What a scene may choose of the material point method.
#pragma once

namespace snowshed {

enum class Precision { float32, float64 };
enum class Transfer { flip, apic };
enum class Basis { quadratic, cubic };

/// Settings of the material point method: grid, transfer, time step, sleep.
struct MpmSettings {
  double dx = 0.01;  // m, grid and voxel size
  Precision precision = Precision::float32;
  Transfer transfer = Transfer::flip;
  double flip_ratio = 0.99;
  Basis basis = Basis::quadratic;
  double courant_factor = 0.9;  // time step over the largest stable one
  double strain_limit = 0.2;    // largest |dt grad v| a step may impose on a particle
  double sleep_speed = 0.02;    // m/s, snow slower than this drops out of the steps; 0: never
  double sleep_time = 0.04;     // s, for how long it must have been slower
  int threads = 0;              // 0: all

  /// The size of the smallest thing the method resolves, m.
  double resolution() const { return dx; }
};

}  // namespace snowshed
