// How the solver lets snow sleep: what mpm/sleep.hpp must know of each block, and what happens to
// blocks that fall asleep.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {
namespace {

/// Steps between looks for snow to fall asleep or to wake: a wave crosses less than a block.
constexpr int steps_between_checks = 8;

}  // namespace

/// Blocks that fall asleep come to rest: what is left of their motion is lost.
template <class T, int D>
void MpmSolver<T, D>::let_sleep() {
  if (!sleep_.allowed() || counters_.steps % steps_between_checks != 0) return;
  const ParticleView<T> view = particles_.view();
  const StepParameters<T> step = parameters(dt_);
  const auto fallen = sleep_.update(layout_, time_, steps_between_checks, dt_, block_probe());
  for (std::int32_t b : fallen) {
    energy_balance_.sleep += grid_.block_stats[b].kinetic;
    energy_balance_.kinetic -= grid_.block_stats[b].kinetic;
    particles_.zero_velocity(layout_.first[b], layout_.first[b + 1]);
    scatter_block(step, view, b);
  }
  if (!fallen.empty()) clear_idle_nodes();
}

template <class T, int D>
typename Sleep<D>::BlockProbe MpmSolver<T, D>::block_probe() {
  typename Sleep<D>::BlockProbe block_probe;
  block_probe.fastest = [this](std::int32_t b) {
    return std::sqrt(grid_.block_stats[b].speed_squared);
  };
  block_probe.speed = [this](std::int32_t b) {
    return particles_.rms_speed(layout_.first[b], layout_.first[b + 1]);
  };
  block_probe.velocity = [this](std::int32_t b) {
    return particles_.mean_velocity(layout_.first[b], layout_.first[b + 1]);
  };
  block_probe.carried = [this](std::int32_t b) {
    const T *sums[neighbour_count<D>], *velocities[neighbour_count<D>];
    for (int k = 0; k < neighbour_count<D>; ++k) {
      const std::int32_t g = layout_.around_particles[b][k];
      const bool moves = sleep_.is_active(g) && grid_.touched[g];
      sums[k] = moves ? grid_.sum(g) : nullptr;
      velocities[k] = moves ? grid_.velocity(g) : nullptr;
    }
    CarriedMotion motion;
    kernels_.carried_motion(grid_.tile(b), sums, velocities, motion);
    return motion;
  };
  block_probe.obstacle_moves = [this](std::int32_t b) {
    const auto& around = layout_.around_particles[b];
    return contacts_.any_motion() && std::any_of(around.begin(), around.end(), [&](std::int32_t g) {
             return contacts_.moves(std::size_t(g));
           });
  };
  return block_probe;
}

/// Nodes that only sleeping snow touches are at rest.
template <class T, int D>
void MpmSolver<T, D>::clear_idle_nodes() {
  for (std::int32_t g : sleep_.idle()) {
    grid_.node_stats[g] = {};
    std::fill_n(grid_.velocity(g), grid_.block_size, T(0));
  }
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
