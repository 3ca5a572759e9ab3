// Snow at rest: which blocks of particles sleep, and which blocks of nodes are then not needed.
//
// A block of particles falls asleep when its particles and the nodes around it have been slower
// than a limit for some time, without growing faster. A sleeping block takes no part in a step, but
// keeps its mass and its force on its tile, so that its neighbours rest on it. It wakes when nodes
// that it shares with awake snow become twice as fast as the limit, when particles come or go, and
// when an obstacle moves through its nodes. An unbalanced force at its border accelerates those
// nodes until it wakes, so what sleeping may leave out is motion slower than the limit.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "snowshed/mpm/block_layout.hpp"
#include "snowshed/mpm/quiet_spell.hpp"

namespace snowshed {

template <int D>
class Sleep {
 public:
  /// Speed limit (m/s; 0: nothing ever sleeps) and time (s).
  Sleep(double speed, double time) : limit_(speed), time_(time) {}

  /// After a sort: blocks that kept their particles keep their state, all others are awake.
  void relocate(const BlockLayout<D>& layout, double now);

  /// Everything awake, from now on.
  void wake_all(const BlockLayout<D>& layout, double now);

  /// After a step. `obstacle_moves(g)` tells whether an obstacle moves through grid block g.
  /// Returns the particle blocks that have just fallen asleep.
  std::vector<std::int32_t> update(const BlockLayout<D>& layout, std::int64_t step, double now,
                                   const std::vector<BlockStats>& particles,
                                   const std::vector<NodeStats>& nodes,
                                   const std::function<bool(std::int32_t)>& obstacle_moves);

  bool asleep(std::size_t block) const { return states_[block].asleep; }
  /// Particle blocks that take part in a step, and the grid blocks that they touch; ascending.
  const std::vector<std::int32_t>& awake() const { return awake_; }
  const std::vector<std::int32_t>& active() const { return active_; }
  /// Grid blocks that only sleeping snow touches.
  const std::vector<std::int32_t>& idle() const { return idle_; }
  std::int64_t awake_particles() const { return awake_particles_; }

  /// What is known of one block of particles.
  struct State {
    QuietSpell quiet;
    bool asleep = false;
  };
  const std::vector<State>& states() const { return states_; }
  /// States from a checkpoint, one for each particle block of the layout.
  void restore(const BlockLayout<D>& layout, std::vector<State> states);

 private:
  void list_blocks(const BlockLayout<D>& layout);

  double limit_, time_;
  std::vector<BlockKey> keys_;        // of the layout that `states_` belongs to
  std::vector<std::int32_t> counts_;  // particles in each of its blocks
  std::vector<State> states_;
  std::vector<std::int32_t> awake_, active_, idle_;
  std::vector<std::int32_t> border_;  // sleeping blocks that share nodes with awake snow
  std::int64_t awake_particles_ = 0;
};

}  // namespace snowshed
