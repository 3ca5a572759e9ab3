#include "snowshed/run/rest_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snowshed::run {
namespace {

/// The time at which the detector first finds rest in 2 s of `speed(t)`; negative if it never does.
template <class Speed>
double time_of_rest(RestDetector detector, double start, Speed speed) {
  detector.start_event(start);
  for (double t = start; t < start + 2; t += 0.001)
    if (detector.due(t) && detector.at_rest(t, speed(t - start))) return t - start;
  return -1;
}

TEST(RestDetector, WaitsUntilSnowHasBeenSlowForTheRestTime) {
  const RestDetector detector(0.02, 0.05);
  for (double start : {0.0, 7.5}) {
    const double t = time_of_rest(detector, start, [](double t) { return t < 0.3 ? 1.0 : 0.01; });
    EXPECT_GT(t, 0.3 + 0.04);
    EXPECT_LT(t, 0.3 + 0.07);
  }
}

TEST(RestDetector, NeverStopsMovingSnow) {
  const RestDetector detector(0.02, 0.05);
  EXPECT_LT(time_of_rest(detector, 0, [](double) { return 0.021; }), 0);
  // Bursts of motion more frequent than the rest time.
  EXPECT_LT(
      time_of_rest(detector, 0, [](double t) { return std::fmod(t, 0.045) < 0.01 ? 0.1 : 0.001; }),
      0);
}

TEST(RestDetector, DoesNotTakeASlowStartForRest) {
  // A slab on a slope just above its angle of repose starts slowly: 0.1 m/s^2.
  const RestDetector detector(0.02, 0.05);
  EXPECT_LT(time_of_rest(detector, 0, [](double t) { return 0.1 * t; }), 0);
}

TEST(RestDetector, AcceptsSnowThatSlowsDown) {
  const RestDetector detector(0.02, 0.05);
  const double t = time_of_rest(detector, 0, [](double t) { return 0.5 * std::exp(-t / 0.1); });
  EXPECT_NEAR(t, 0.1 * std::log(0.5 / 0.02) + 0.05, 0.02);
}

TEST(RestDetector, RestoresItsState) {
  RestDetector original(0.02, 0.05), restored(0.02, 0.05);
  original.start_event(1.0);
  original.at_rest(1.0, 0.015);
  original.at_rest(1.03, 0.01);
  restored.restore(original.state());
  EXPECT_EQ(restored.due(1.031), original.due(1.031));
  EXPECT_FALSE(restored.at_rest(1.04, 0.01));
  EXPECT_TRUE(restored.at_rest(1.06, 0.01));
  EXPECT_EQ(restored.speed(), 0.01);
}

}  // namespace
}  // namespace snowshed::run
