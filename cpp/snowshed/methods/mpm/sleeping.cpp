// How the solver lets snow sleep: what mpm/sleep.hpp must know of each block, and what happens to
// blocks that fall asleep.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {
namespace {

/// Steps between the checks whether snow falls asleep or wakes: a wave crosses less than a block.
constexpr int steps_between_checks = 8;

}  // namespace

/// Blocks that fall asleep come to rest: what is left of their motion is lost.
template <class T, int D>
void MpmSolver<T, D>::let_sleep() noexcept {
  if (!state_.sleep.allowed() || counters().steps % steps_between_checks != 0) return;
  const ParticleView<T> view = state_.particles.view();
  const StepParameters<T> step = parameters(state_.progress.dt);
  const auto& fallen =
      state_.sleep.update(state_.layout, time(), steps_between_checks, time_step(), block_probe());
  for (std::int32_t b : fallen) {
    state_.progress.energy.sleep += work_.grid.block_stats[b].kinetic;
    state_.progress.energy.kinetic -= work_.grid.block_stats[b].kinetic;
    state_.particles.zero_velocity(state_.layout.first[b], state_.layout.first[b + 1]);
    scatter_block(step, view, b);
  }
  if (!fallen.empty()) clear_idle_nodes();
}

template <class T, int D>
typename Sleep<D>::BlockProbe MpmSolver<T, D>::block_probe() {
  typename Sleep<D>::BlockProbe block_probe;
  block_probe.fastest = [this](std::int32_t b) {
    return std::sqrt(work_.grid.block_stats[b].speed_squared);
  };
  block_probe.speed = [this](std::int32_t b) {
    return state_.particles.rms_speed(state_.layout.first[b], state_.layout.first[b + 1]);
  };
  block_probe.velocity = [this](std::int32_t b) {
    return state_.particles.mean_velocity(state_.layout.first[b], state_.layout.first[b + 1]);
  };
  block_probe.carried = [this](std::int32_t b) {
    const T *sums[neighbour_count<D>], *velocities[neighbour_count<D>];
    for (int k = 0; k < neighbour_count<D>; ++k) {
      const std::int32_t g = state_.layout.around_particles[b][k];
      const bool moves = state_.sleep.is_active(g) && work_.grid.touched[g];
      sums[k] = moves ? work_.grid.sum(g) : nullptr;
      velocities[k] = moves ? work_.grid.velocity(g) : nullptr;
    }
    CarriedMotion motion;
    model_.kernels.carried_motion(work_.grid.tile(b), work_.grid.block_stats[b].reach, sums,
                                  velocities, motion);
    return motion;
  };
  block_probe.obstacle_moves = [this](std::int32_t b) {
    const auto& around = state_.layout.around_particles[b];
    return model_.boundary.any_motion() &&
           std::any_of(around.begin(), around.end(),
                       [&](std::int32_t g) { return state_.contacts.moves(std::size_t(g)); });
  };
  block_probe.holds_its_snow = [this](std::int32_t b) {
    return state_.particles.lie_within_block(state_.layout.first[b], state_.layout.first[b + 1]);
  };
  return block_probe;
}

/// Nodes that only sleeping snow touches are at rest.
template <class T, int D>
void MpmSolver<T, D>::clear_idle_nodes() {
  for (std::int32_t g : state_.sleep.idle()) {
    work_.grid.node_stats[g] = {};
    std::fill_n(work_.grid.velocity(g), work_.grid.block_size, T(0));
  }
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
