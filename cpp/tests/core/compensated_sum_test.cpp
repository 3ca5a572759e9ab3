#include "snowshed/core/compensated_sum.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace snowshed {
namespace {

TEST(CompensatedSum, KeepsSmallTermsBesideLargeOnes) {
  const std::vector<double> values{1, 1e100, 1, -1e100};
  EXPECT_EQ(compensated_sum(values.data(), values.size()), 2);
}

TEST(CompensatedSum, DoesNotDriftWithTheNumberOfTerms) {
  const std::vector<double> values(1'000'000, 0.1);
  EXPECT_EQ(compensated_sum(values.data(), values.size()), 100'000);
}

TEST(CompensatedSum, AnEmptySumIsZero) { EXPECT_EQ(compensated_sum(nullptr, 0), 0); }

}  // namespace
}  // namespace snowshed
