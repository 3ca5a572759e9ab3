#include "snowshed/mpm/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snowshed {
namespace {

/// Steps between looks for blocks to fall asleep. Waking is looked for in every step.
constexpr int steps_between_looks = 8;

/// Speed that wakes, over the speed below which snow falls asleep.
constexpr double waking = 2;

/// Speed of the fastest node of a block, m/s.
template <int D>
double node_speed(const NodeStats& stats) {
  double squared = 0;
  for (int d = 0; d < D; ++d) {
    if (stats.low[d] > stats.high[d]) return 0;  // no snow here
    const double v = std::max(-stats.low[d], stats.high[d]);
    squared += v * v;
  }
  return std::sqrt(squared);
}

template <int D>
double fastest_around(const BlockLayout<D>& layout, std::int32_t block,
                      const std::vector<NodeStats>& nodes) {
  double fastest = 0;
  for (std::int32_t g : layout.around_particles[block])
    fastest = std::max(fastest, node_speed<D>(nodes[g]));
  return fastest;
}

template <int D>
std::vector<std::int32_t> particle_counts(const BlockLayout<D>& layout) {
  std::vector<std::int32_t> counts;
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    counts.push_back(layout.first[b + 1] - layout.first[b]);
  return counts;
}

}  // namespace

template <int D>
void Sleep<D>::relocate(const BlockLayout<D>& layout, double now) {
  State fresh;
  fresh.quiet.since = now;
  std::vector<State> states(layout.particle_blocks.size(), fresh);
  std::vector<std::int32_t> counts = particle_counts(layout);
  std::size_t old = 0;
  for (std::size_t b = 0; b < states.size(); ++b) {
    while (old < keys_.size() && keys_[old] < layout.particle_blocks[b]) ++old;
    if (old == keys_.size()) break;
    if (keys_[old] != layout.particle_blocks[b]) continue;
    states[b] = states_[old];
    // Snow that sleeps does not leave its block, so any change is snow that came.
    if (states[b].asleep && counts[b] != counts_[old]) states[b] = fresh;
  }
  keys_ = layout.particle_blocks;
  counts_ = std::move(counts);
  states_ = std::move(states);
  list_blocks(layout);
}

template <int D>
void Sleep<D>::wake_all(const BlockLayout<D>& layout, double now) {
  State fresh;
  fresh.quiet.since = now;
  std::fill(states_.begin(), states_.end(), fresh);
  list_blocks(layout);
}

template <int D>
void Sleep<D>::restore(const BlockLayout<D>& layout, std::vector<State> states) {
  keys_ = layout.particle_blocks;
  counts_ = particle_counts(layout);
  states_ = std::move(states);
  list_blocks(layout);
}

template <int D>
std::vector<std::int32_t> Sleep<D>::update(
    const BlockLayout<D>& layout, std::int64_t step, double now,
    const std::vector<BlockStats>& particles, const std::vector<NodeStats>& nodes,
    const std::function<bool(std::int32_t)>& obstacle_moves) {
  std::vector<std::int32_t> fallen;
  if (!(limit_ > 0)) return fallen;
  const auto disturbed = [&](std::int32_t b) {
    const auto& around = layout.around_particles[b];
    return std::any_of(around.begin(), around.end(), obstacle_moves);
  };
  bool woken = false;
  for (std::int32_t b : border_) {
    if (!(fastest_around(layout, b, nodes) > waking * limit_) && !disturbed(b)) continue;
    states_[b] = {{now, 0.0}, false};
    woken = true;
  }
  if (step % steps_between_looks == 0) {
    for (std::int32_t b : awake_) {
      double speed = std::sqrt(particles[b].speed_squared);
      if (speed < limit_) speed = std::max(speed, fastest_around(layout, b, nodes));
      State& s = states_[b];
      if (!s.quiet.lasts(now, speed, limit_, time_) || disturbed(b)) continue;
      s.asleep = true;
      fallen.push_back(b);
    }
  }
  if (woken || !fallen.empty()) list_blocks(layout);
  return fallen;
}

template <int D>
void Sleep<D>::list_blocks(const BlockLayout<D>& layout) {
  awake_.clear();
  awake_particles_ = 0;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (states_[b].asleep) continue;
    awake_.push_back(std::int32_t(b));
    awake_particles_ += counts_[b];
  }
  std::vector<bool> touched(layout.grid_blocks.size(), false);
  for (std::int32_t b : awake_)
    for (std::int32_t g : layout.around_particles[b]) touched[g] = true;
  active_.clear();
  idle_.clear();
  for (std::size_t g = 0; g < touched.size(); ++g)
    (touched[g] ? active_ : idle_).push_back(std::int32_t(g));
  border_.clear();
  if (idle_.empty() && awake_.size() == states_.size()) return;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (!states_[b].asleep) continue;
    const auto& around = layout.around_particles[b];
    if (std::any_of(around.begin(), around.end(), [&](std::int32_t g) { return touched[g]; }))
      border_.push_back(std::int32_t(b));
  }
}

template class Sleep<2>;
template class Sleep<3>;

}  // namespace snowshed
