// The rules by which blocks fall asleep and wake, without a solver: one of two neighbouring blocks
// is always awake.
#include <gtest/gtest.h>

#include "snowshed/methods/mpm/sleep.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double speed_limit = 0.02, time_to_sleep = 0.04, step = 1e-4;
constexpr int steps_between_checks = 8;

/// Measurements of the quiet block.
struct QuietBlock {
  double speed = 0, fastest = 0;
  SleepingBlockMotion carried;
  VecD<2> velocity = VecD<2>::Zero();
};

class SleepRules : public testing::Test {
 protected:
  /// Checks the blocks every few steps for a time (s). Returns whether the quiet block sleeps at
  /// the end.
  bool sleeps_after(double duration, const QuietBlock& block) {
    Sleep<2>::BlockProbe probe;
    probe.fastest = [&](std::int32_t b) { return b == 0 ? 1.0 : block.fastest; };
    probe.speed = [&](std::int32_t b) { return b == 0 ? 1.0 : block.speed; };
    probe.velocity = [&](std::int32_t) { return block.velocity; };
    probe.carried = [&](std::int32_t) { return block.carried; };
    probe.obstacle_moves = [](std::int32_t) { return false; };
    probe.holds_its_snow = [](std::int32_t) { return true; };
    for (const double end = now_ + duration; now_ < end; now_ += steps_between_checks * step)
      sleep_.update(layout_, now_, steps_between_checks, step, probe);
    return sleep_.states()[1].asleep;
  }

  void wake_all() { sleep_.wake_all(layout_, now_); }
  void fall_asleep() {
    ASSERT_TRUE(sleeps_after(2 * time_to_sleep, {0.5 * speed_limit, speed_limit, {}}));
  }

  const BlockLayout<2> layout_ =
      BlockLayout<2>::of({block_key<2>({0, 0}), block_key<2>({1, 0})}, {0, 50, 100}, 1);
  double now_ = 0;
  Sleep<2> sleep_ = Sleep<2>(speed_limit, time_to_sleep, 9.81).relocated(layout_, 0.0);
};

TEST_F(SleepRules, BlocksSleepAfterTheTimeBelowTheLimit) {
  EXPECT_FALSE(sleeps_after(0.9 * time_to_sleep, {0.9 * speed_limit, speed_limit, {}}));
  EXPECT_TRUE(sleeps_after(0.3 * time_to_sleep, {0.9 * speed_limit, speed_limit, {}}));
}

TEST_F(SleepRules, FastBlocksAndFastParticlesStayAwake) {
  EXPECT_FALSE(sleeps_after(5 * time_to_sleep, {1.1 * speed_limit, speed_limit, {}}));
  EXPECT_FALSE(sleeps_after(5 * time_to_sleep, {0.5 * speed_limit, 6 * speed_limit, {}}));
  EXPECT_TRUE(sleeps_after(5 * time_to_sleep, {0.5 * speed_limit, 4 * speed_limit, {}}));
}

/// The mean velocity is 2 mm/s in the first half of the time to fall asleep, and smaller or larger
/// in the second.
TEST_F(SleepRules, BlocksThatSetOffStayAwake) {
  for (const double second : {0.001, 0.009}) {
    wake_all();
    QuietBlock block{0.5 * speed_limit, speed_limit, {}, VecD<2>(0.0, -0.002)};
    sleeps_after(0.5 * time_to_sleep, block);
    block.velocity[1] = -second;
    EXPECT_EQ(sleeps_after(0.55 * time_to_sleep, block), second < 0.002) << second;
  }
}

TEST_F(SleepRules, BlocksThatGravitySlowsDownStayAwake) {
  const double lost_speed = 9.81 * 0.5 * time_to_sleep;  // from one half to the other
  for (const double part : {0.3, 0.7}) {
    wake_all();
    QuietBlock block{0.5 * speed_limit, speed_limit, {}, VecD<2>(0.0, lost_speed)};
    sleeps_after(0.5 * time_to_sleep, block);
    block.velocity[1] = (1 - part) * lost_speed;
    EXPECT_EQ(sleeps_after(0.55 * time_to_sleep, block), part < 0.5) << part;
  }
}

TEST_F(SleepRules, BlocksWakeIfTheirNeighbourCarriesThemBeyondTheLimit) {
  for (const double part : {0.9, 1.1}) {
    fall_asleep();
    QuietBlock block{0, 0, {}};
    block.carried.speed_squared = part * part * speed_limit * speed_limit;
    EXPECT_EQ(sleeps_after(4.5 * steps_between_checks * step, block), part < 1) << part;
  }
}

/// Snow falls asleep after a time t. Within this time a steady force that causes the acceleration a
/// gives it the velocity a t.
TEST_F(SleepRules, SteadyForcesWakeBlocks) {
  for (const double part : {0.8, 1.2}) {
    fall_asleep();
    QuietBlock block{1.0, 1.0, {}};  // fast: once awake, the block stays awake
    block.carried.change[1] = part * speed_limit / time_to_sleep * step;
    EXPECT_EQ(sleeps_after(10 * time_to_sleep, block), part < 1) << part;
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
