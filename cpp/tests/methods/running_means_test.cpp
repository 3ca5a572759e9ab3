// Means of forces over windows of time, against means that are known.
#include "snowshed/methods/running_means.hpp"

#include <gtest/gtest.h>

#include "snowshed/core/random.hpp"

namespace snowshed::methods {
namespace {

TEST(RunningMeans, ConstantForceIsItsOwnMean) {
  for (const double dt : {1e-5, 3.7e-4, 0.004, 0.05, 0.4}) {
    RunningMeans means;
    double time = 0;
    while (time < 0.5) means.add(Vec3(3, 0, -4) * dt, time += dt, dt);
    EXPECT_LT((means.mean(1) - Vec3(3, 0, -4)).norm(), 1e-9) << dt;
    EXPECT_NEAR(means.peak(1).norm(), 5, 1e-9) << dt;
  }
}

/// A pulse of 2 ms within a window of 10 ms: its mean is a fifth of it, wherever it begins.
TEST(RunningMeans, FindsThePeakOfAShortPulse) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const double begin = 0.05 + 0.01 * random.uniform();
    RunningMeans means;
    double time = 0;
    while (time < 0.2) {
      const double dt = 1e-4 * (0.5 + random.uniform());
      const double inside =
          std::max(0.0, std::min(time + dt, begin + 0.002) - std::max(time, begin));
      means.add(Vec3(0, 0, -50 * inside), time += dt, dt);
    }
    EXPECT_NEAR(means.peak(1).z(), -10, 0.02);
    EXPECT_NEAR(means.peak_time(1), begin + 0.002, 0.0025 + 0.0005 + 0.006);
    EXPECT_LT(means.mean(1).norm(), 1e-12);
  }
}

TEST(RunningMeans, ForgetsThePeakOfTheLastEvent) {
  RunningMeans means;
  means.add(Vec3(7, 0, 0) * 0.01, 0.01, 0.01);
  means.add(Vec3::Zero(), 0.02, 0.01);
  means.begin_event(0.02);
  means.add(Vec3(1, 0, 0) * 0.01, 0.03, 0.01);
  EXPECT_NEAR(means.peak(1).x(), 1, 1e-12);
  EXPECT_GT(means.peak_time(1), 0.02);
}

}  // namespace
}  // namespace snowshed::methods
