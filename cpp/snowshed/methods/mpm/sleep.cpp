#include "snowshed/methods/mpm/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Largest speed of a single particle in a slow block, over the limit.
constexpr double max_fastest_over_limit = 5;

/// Largest growth of the mean speed between the halves of a quiet period, relative to the limit,
/// that counts as vibration.
constexpr double max_speed_gain = 0.005;

/// Share of the velocity change of a free fall above which snow is in flight.
constexpr double min_flight_share = 0.5;

/// Smallest number of samples in the mean of a half, whatever the length of the steps.
constexpr double min_samples = 4;

template <int D>
std::vector<std::int32_t> particle_counts(const BlockLayout<D>& layout) {
  std::vector<std::int32_t> counts;
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    counts.push_back(layout.first[b + 1] - layout.first[b]);
  return counts;
}

}  // namespace

template <int D>
typename Sleep<D>::State Sleep<D>::awake_since(double now) {
  State state;
  state.since = now;
  return state;
}

template <int D>
Sleep<D> Sleep<D>::relocated(const BlockLayout<D>& layout, double now) const {
  std::vector<State> states(layout.particle_blocks.size(), awake_since(now));
  const std::vector<std::int32_t> counts = particle_counts(layout);
  std::size_t old = 0;
  for (std::size_t b = 0; b < states.size(); ++b) {
    while (old < keys_.size() && keys_[old] < layout.particle_blocks[b]) ++old;
    if (old == keys_.size()) break;
    if (keys_[old] != layout.particle_blocks[b]) continue;
    states[b] = states_[old];
    // Sleeping snow does not leave its block, so a changed number means that snow has arrived.
    if (states[b].asleep && counts[b] != counts_[old]) states[b] = awake_since(now);
  }
  return with_states(layout, std::move(states));
}

template <int D>
Sleep<D> Sleep<D>::with_states(const BlockLayout<D>& layout, std::vector<State> states) const {
  Sleep next(limit_, time_, gravity_);
  const std::size_t blocks = layout.particle_blocks.size(), nodes = layout.grid_blocks.size();
  for (auto* list : {&next.awake_, &next.border_, &next.newly_asleep_}) list->reserve(blocks);
  for (auto* list : {&next.active_, &next.idle_}) list->reserve(nodes);
  next.touched_.resize(nodes);
  next.keys_ = layout.particle_blocks;
  next.counts_ = particle_counts(layout);
  next.states_ = std::move(states);
  next.list_blocks(layout);
  return next;
}

template <int D>
void Sleep<D>::wake_all(const BlockLayout<D>& layout, double now) noexcept {
  std::fill(states_.begin(), states_.end(), awake_since(now));
  list_blocks(layout);
}

template <int D>
const std::vector<std::int32_t>& Sleep<D>::update(const BlockLayout<D>& layout, double now,
                                                  int steps, double dt,
                                                  const BlockProbe& block_probe) noexcept {
  bool woken = false;
  const auto wake = [&](std::int32_t b) {
    states_[b] = awake_since(now);
    woken = true;
  };
  for (std::int32_t b : border_) {
    if (is_pushed(states_[b], steps, dt, block_probe.carried(b))) wake(b);
  }
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (states_[b].asleep && block_probe.obstacle_moves(std::int32_t(b))) wake(std::int32_t(b));
  newly_asleep_.clear();
  for (std::int32_t b : awake_) {
    if (!is_slow(block_probe.speed(b), block_probe.fastest(b)) || block_probe.obstacle_moves(b))
      states_[b] = awake_since(now);
    else if (falls_asleep(states_[b], now, block_probe.velocity(b)) &&
             block_probe.holds_its_snow(b))
      newly_asleep_.push_back(b);
  }
  for (std::int32_t b : newly_asleep_) {
    states_[b].asleep = true;
    states_[b].sum.setZero();
  }
  if (woken || !newly_asleep_.empty()) list_blocks(layout);
  return newly_asleep_;
}

template <int D>
bool Sleep<D>::is_slow(double rms_speed, double fastest) const {
  return rms_speed < limit_ && fastest < max_fastest_over_limit * limit_;
}

/// Returns whether the awake snow beside a sleeping block would carry it, or presses harder than it
/// withstands. Forces do not move sleeping snow, so their effect is summed up, and the effect of
/// older forces fades.
template <int D>
bool Sleep<D>::is_pushed(State& s, int steps, double dt, const SleepingBlockMotion& carried) const {
  s.sum *= std::max(0.0, 1.0 - steps * dt / time_);
  for (int d = 0; d < D; ++d) s.sum[d] += steps * carried.change[d];
  return carried.speed_squared > limit_ * limit_ || s.sum.norm() > limit_;
}

/// Returns whether a slow block has been slow for long enough and neither sets off nor is in
/// flight. From the first half of that time to the second it must neither have sped up along its
/// motion nor have changed its velocity as gravity alone would change it. Means over time
/// distinguish motion from vibration.
template <int D>
bool Sleep<D>::falls_asleep(State& s, double now, const VecD<D>& velocity) const {
  s.sum += velocity;
  s.samples += 1;
  if (s.samples < min_samples || now - s.since < 0.5 * time_) return false;
  if (s.halfway && now - s.since < time_) return false;
  const VecD<D> mean = s.sum / s.samples;
  const VecD<D> change = mean - s.first_half;
  const bool sets_off = change.dot(mean) > max_speed_gain * limit_ * mean.norm();
  const bool flies = gravity_ > 0 && change.norm() > min_flight_share * gravity_ * 0.5 * time_;
  if (s.halfway && !sets_off && !flies) return true;
  // Either the first half ends, or the second half becomes the first one.
  s.since = now - 0.5 * time_;
  s.halfway = true;
  s.first_half = mean;
  s.sum.setZero();
  s.samples = 0;
  return false;
}

template <int D>
void Sleep<D>::list_blocks(const BlockLayout<D>& layout) noexcept {
  awake_.clear();
  awake_particles_ = 0;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (states_[b].asleep) continue;
    awake_.push_back(std::int32_t(b));
    awake_particles_ += counts_[b];
  }
  std::fill(touched_.begin(), touched_.end(), false);
  for (std::int32_t b : awake_)
    for (std::int32_t g : layout.around_particles[b]) touched_[g] = true;
  // In an overlap, the snow of each field acts on that of the others.
  for (std::size_t i = 0; i + 1 < layout.overlap_first.size(); ++i) {
    const auto begin = layout.overlap_blocks.begin() + layout.overlap_first[i];
    const auto end = layout.overlap_blocks.begin() + layout.overlap_first[i + 1];
    if (std::any_of(begin, end, [&](std::int32_t g) { return touched_[g]; }))
      std::for_each(begin, end, [&](std::int32_t g) { touched_[g] = true; });
  }
  active_.clear();
  idle_.clear();
  for (std::size_t g = 0; g < touched_.size(); ++g)
    (touched_[g] ? active_ : idle_).push_back(std::int32_t(g));
  border_.clear();
  if (idle_.empty() && awake_.size() == states_.size()) return;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (!states_[b].asleep) continue;
    const auto& around = layout.around_particles[b];
    if (std::any_of(around.begin(), around.end(), [&](std::int32_t g) { return touched_[g]; }))
      border_.push_back(std::int32_t(b));
  }
}

template class Sleep<2>;
template class Sleep<3>;

// --- how the solver lets snow sleep --------------------------------------------------------------

/// Blocks that fall asleep stop: their remaining motion is lost.
template <class T, int D>
void SolverImpl<T, D>::update_sleep() noexcept {
  if (!state_.sleep.allowed() || counters().steps % steps_between_checks != 0) return;
  const ParticleView<T> view = state_.particles.view();
  const StepParameters<T> step = parameters(state_.totals.dt);
  if (state_.forces) workspace_.idle_before = state_.sleep.idle();
  const auto& newly_asleep =
      state_.sleep.update(state_.layout, time(), steps_between_checks, time_step(), block_probe());
  for (std::int32_t b : newly_asleep) {
    state_.totals.energy.put_to_sleep(workspace_.grid.block_stats[b].energy.kinetic);
    state_.particles.zero_velocity(state_.layout.first[b], state_.layout.first[b + 1]);
    scatter_block(step, view, b);
  }
  if (!newly_asleep.empty()) rest_idle_nodes();
  if (state_.forces && workspace_.idle_before != state_.sleep.idle()) {
    state_.collect_forces(model_, workspace_.idle_before);
    hold_sleeping_forces();
  }
}

template <class T, int D>
typename Sleep<D>::BlockProbe SolverImpl<T, D>::block_probe() {
  typename Sleep<D>::BlockProbe block_probe;
  block_probe.fastest = [this](std::int32_t b) {
    return std::sqrt(workspace_.grid.block_stats[b].max_speed_squared);
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
      const bool moves = state_.sleep.is_active(g) && workspace_.grid.touched[g];
      sums[k] = moves ? workspace_.grid.sum(g) : nullptr;
      velocities[k] = moves ? workspace_.grid.velocity(g) : nullptr;
    }
    SleepingBlockMotion motion;
    model_.kernels.carried_motion(workspace_.grid.tile(b), workspace_.grid.block_stats[b].reach,
                                  sums, velocities, motion);
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

/// Nodes that only sleeping snow touches are at rest. Their sums stay valid while they are idle.
template <class T, int D>
void SolverImpl<T, D>::rest_idle_nodes() {
  for (std::int32_t g : state_.sleep.idle()) {
    workspace_.grid.node_stats[g] = {};
    std::fill_n(workspace_.grid.velocity(g), workspace_.grid.block_size, T(0));
    if (!state_.layout.has_overlap.empty()) gather(g);
  }
}

template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

}  // namespace snowshed::methods::mpm
