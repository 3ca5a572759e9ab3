// Means of forces over windows of time, against means that are known.
#include "snowshed/methods/forces/running_mean.hpp"

#include <gtest/gtest.h>

#include "snowshed/core/random.hpp"

namespace snowshed::methods {
namespace {

TEST(RunningMean, OfAConstantForceIsThatForce) {
  for (const double dt : {1e-5, 3.7e-4, 0.004, 0.05, 0.4}) {
    RunningMean mean(0.01);
    double time = 0;
    while (time < 0.5) mean.add(Vec3(3, 0, -4) * dt, time += dt, dt);
    EXPECT_LT((mean.mean() - Vec3(3, 0, -4)).norm(), 1e-9) << dt;
    EXPECT_NEAR(mean.peak().norm(), 5, 1e-9) << dt;
  }
}

/// A pulse of 2 ms within a window of 10 ms: its mean is a fifth of it, wherever it begins.
TEST(RunningMean, FindsThePeakOfAShortPulse) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const double begin = 0.05 + 0.01 * random.uniform();
    RunningMean mean(0.01);
    double time = 0;
    while (time < 0.2) {
      const double dt = 1e-4 * (0.5 + random.uniform());
      const double inside = std::max(
          0.0, std::min(time + dt, begin + 0.002) - std::max(time, begin));
      mean.add(Vec3(0, 0, -50 * inside), time += dt, dt);
    }
    EXPECT_NEAR(mean.peak().z(), -10, 0.02);
    EXPECT_NEAR(mean.peak_time(), begin + 0.002, 0.0025 + 0.0005 + 0.006);
    EXPECT_LT(mean.mean().norm(), 1e-12);
  }
}

TEST(RunningMean, ForgetsThePeakOfTheLastEvent) {
  RunningMean mean(0.001);
  mean.add(Vec3(7, 0, 0) * 0.01, 0.01, 0.01);
  mean.add(Vec3::Zero(), 0.02, 0.01);
  mean.begin_event(0.02);
  mean.add(Vec3(1, 0, 0) * 0.01, 0.03, 0.01);
  EXPECT_NEAR(mean.peak().x(), 1, 1e-12);
  EXPECT_GT(mean.peak_time(), 0.02);
}

}  // namespace
}  // namespace snowshed::methods
