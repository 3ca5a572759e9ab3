#include "snowshed/core/random.hpp"

#include <gtest/gtest.h>

namespace snowshed {
namespace {

TEST(Random, GivesThePublishedSequence) {
  Random random(1234567);  // reference values of the author's C code
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

TEST(Random, UniformNumbersFillTheOpenUnitInterval) {
  Random random(1);
  double sum = 0, squares = 0;
  constexpr int samples = 100000;
  for (int n = 0; n < samples; ++n) {
    const double u = random.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / samples, 1.0 / 2, 0.005);
  EXPECT_NEAR(squares / samples, 1.0 / 3, 0.005);
}

}  // namespace
}  // namespace snowshed
