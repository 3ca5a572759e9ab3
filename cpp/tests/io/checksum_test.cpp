#include "snowshed/io/checksum.hpp"

#include <gtest/gtest.h>

#include <array>

namespace snowshed::io {
namespace {

using Words = std::array<std::uint64_t, 3>;

std::uint64_t sum(const Words& words) {
  Checksum checksum;
  checksum.update(words.data(), sizeof words);
  return checksum.value();
}

TEST(Checksum, DoesNotDependOnThePieces) {
  const Words words = {1, 2, 3};
  Checksum checksum;
  checksum.update(words.data(), 8);
  checksum.update(words.data() + 1, 0);
  checksum.update(words.data() + 1, 16);
  EXPECT_EQ(checksum.value(), sum(words));
}

TEST(Checksum, DependsOnOrderLengthAndZeros) {
  EXPECT_NE(sum({1, 2, 3}), sum({2, 1, 3}));
  EXPECT_NE(sum({0, 0, 0}), Checksum().value());
  EXPECT_NE(sum({0, 0, 1}), sum({0, 0, 0}));
}

TEST(Checksum, HasTheValueOfTheFileFormat) { EXPECT_EQ(sum({1, 2, 3}), 0xc07b167c3203d34u); }

TEST(Crc32, MatchesZlib) {
  Crc32 sum;
  sum.update("123456789", 9);
  EXPECT_EQ(sum.value(), 0xcbf43926u);  // the check value of the catalogue of CRCs
}

}  // namespace
}  // namespace snowshed::io
