// Shared parts of the tests of the solver on a device: the same snow on the processor and on the
// emulated card.
#pragma once

#include <memory>

#include "methods/mpm/gpu/emulated_kernels.hpp"
#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/mpm/gpu_solver.hpp"

namespace snowshed::methods::mpm::gpu {

/// Size of the cells, m.
inline constexpr double dx = 0.05;

inline Options options_on_gpu(double cell = dx) {
  return options_for({3, Precision::float32}, cell);
}

inline std::shared_ptr<snowshed::gpu::EmulatedDevice> emulated_card(
    snowshed::gpu::Turns turns = snowshed::gpu::Turns::forwards) {
  return std::make_shared<snowshed::gpu::EmulatedDevice>(emulated_kernels(), turns);
}

inline std::unique_ptr<Solver> make_emulated(
    const Options& options, std::vector<Obstacle> obstacles,
    snowshed::gpu::Turns turns = snowshed::gpu::Turns::forwards) {
  Options o = options;
  o.obstacles = std::move(obstacles);
  return make_gpu_solver(std::move(o), emulated_card(turns));
}

/// The obstacle, on its way up and along x.
inline Obstacle rising(Obstacle obstacle) {
  geometry::MotionSpec motion;
  motion.velocity = Vec3(0.5, 0, 0.8);
  obstacle.motion.emplace(motion);
  return obstacle;
}

/// The largest distance between the particles of two states, m.
inline double largest_distance(const ParticleState& a, const ParticleState& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    largest = std::max(largest, (a.positions[i] - b.positions[i]).norm());
  return largest;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

}  // namespace snowshed::methods::mpm::gpu
