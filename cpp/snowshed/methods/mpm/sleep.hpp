// Snow at rest: blocks of particles that sleep, and blocks of nodes that are then not needed.
//
// A block of particles falls asleep when it has been slower than a limit for some time. The speed
// of a block is the root of the mean square over its particles, none of which may be several times
// faster than the limit. Snow that sets off, or that turns in the air, is slow, too. During that
// time the snow must therefore neither have accelerated along its motion, nor have changed its
// velocity as snow in flight does.
//
// A sleeping block takes no part in a step, but keeps its mass and its stresses on its tile, so
// that its neighbours rest on it. It wakes when nodes that it shares with awake snow would carry it
// faster than the limit, or when the forces at these nodes would do so within the time that it
// takes to fall asleep. It also wakes when particles enter it, and when an obstacle moves through
// its nodes.
//
// The particles of a sleeping block lie within it. If a particle has strayed beyond its block, the
// block falls asleep only after the next sort. Sorting therefore takes no particle from a sleeping
// block. If the number of its particles has changed, the block has gained some.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"

namespace snowshed::methods::mpm {

/// Number of steps between the checks whether snow falls asleep or wakes. A wave crosses less than
/// a block in this time.
inline constexpr int steps_between_checks = 8;

template <int D>
class Sleep {
 public:
  /// Speed limit (m/s; 0: nothing ever sleeps), time (s), and gravity (m/s2), by which flight is
  /// recognised.
  Sleep(double speed, double time, double gravity)
      : limit_(speed), time_(time), gravity_(gravity) {}

  /// Measurements of a particle block that decide when it falls asleep or wakes.
  struct BlockProbe {
    std::function<double(std::int32_t)> fastest;    // speed of its fastest particle, m/s
    std::function<double(std::int32_t)> speed;      // root of the mean square, m/s
    std::function<VecD<D>(std::int32_t)> velocity;  // mean, m/s
    // Motion that the block's nodes would have given it.
    std::function<SleepingBlockMotion(std::int32_t)> carried;
    std::function<bool(std::int32_t)> obstacle_moves;  // whether one moves through its nodes
    std::function<bool(std::int32_t)> holds_its_snow;  // whether its particles lie within it
  };

  /// Checks all blocks at the time `now`, after `steps` steps of dt. Returns the blocks that fall
  /// asleep; the list is valid until the next call.
  const std::vector<std::int32_t>& update(const BlockLayout<D>& layout, double now, int steps,
                                          double dt, const BlockProbe& block_probe) noexcept;

  /// Returns the sleep after a sort. Blocks keep their state, except that a sleeping block that has
  /// gained particles wakes. New blocks are awake.
  Sleep relocated(const BlockLayout<D>& layout, double now) const;

  /// Wakes everything.
  void wake_all(const BlockLayout<D>& layout, double now) noexcept;

  /// Whether anything can sleep at all.
  bool allowed() const { return limit_ > 0; }
  /// Particle blocks that take part in a step, and the grid blocks that they touch; ascending.
  const std::vector<std::int32_t>& awake() const { return awake_; }
  const std::vector<std::int32_t>& active() const { return active_; }
  bool is_active(std::int32_t grid_block) const { return touched_[grid_block]; }
  /// Grid blocks that only sleeping snow touches.
  const std::vector<std::int32_t>& idle() const { return idle_; }
  /// Sleeping blocks that share nodes with awake snow.
  const std::vector<std::int32_t>& border() const { return border_; }
  std::int64_t awake_particles() const { return awake_particles_; }

  /// State of one block of particles.
  struct State {
    bool asleep = false;
    double since = 0;  // start of the present quiet spell, s
    /// While awake, the sum of mean velocities (m/s) in this half of the spell. While asleep, the
    /// velocity (m/s) that recent forces would have given the block.
    VecD<D> sum = VecD<D>::Zero();
    double samples = 0;                    // number of velocities in `sum`
    bool halfway = false;                  // whether the first half of the spell is over
    VecD<D> first_half = VecD<D>::Zero();  // mean velocity in the first half, m/s
  };
  const std::vector<State>& states() const { return states_; }
  /// Returns the sleep with these states, one for each particle block of the layout.
  Sleep with_states(const BlockLayout<D>& layout, std::vector<State> states) const;

 private:
  static State awake_since(double now);
  bool is_slow(double rms_speed, double fastest) const;
  bool is_pushed(State& state, int steps, double dt, const SleepingBlockMotion& carried) const;
  bool falls_asleep(State& state, double now, const VecD<D>& velocity) const;
  void list_blocks(const BlockLayout<D>& layout) noexcept;

  double limit_, time_, gravity_;
  std::vector<BlockKey> keys_;        // keys of the blocks of `states_`
  std::vector<std::int32_t> counts_;  // number of particles in each block
  std::vector<State> states_;
  // The lists have capacity for all blocks, so that no step needs memory for them.
  std::vector<std::int32_t> awake_, active_, idle_, newly_asleep_;
  std::vector<bool> touched_;  // whether awake snow touches a grid block
  std::vector<std::int32_t> border_;
  std::int64_t awake_particles_ = 0;
};

}  // namespace snowshed::methods::mpm
