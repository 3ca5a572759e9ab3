#include "snowshed/core/stopwatch.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace snowshed {
namespace {

TEST(Stopwatch, NeverRunsFast) {
  Stopwatch stopwatch;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_GE(stopwatch.seconds(), 0.020);
  EXPECT_GE(stopwatch.restart(), 0.020);
}

TEST(Stopwatch, RestartsFromZero) {
  const Stopwatch total;
  Stopwatch part;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  part.restart();
  EXPECT_LE(part.seconds() + 0.020, total.seconds());
}

}  // namespace
}  // namespace snowshed
