#include "snowshed/particles/id_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "snowshed/core/random.hpp"

namespace snowshed::particles {
namespace {

/// Ids with bits in every digit of the sort, each once.
TEST(IdOrder, MatchesASort) {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 2u, 5000u}) {
    std::vector<std::uint32_t> ids(count), expected(count);
    for (std::size_t i = 0; i < count; ++i) ids[i] = std::uint32_t(i * 2654435761u);
    for (std::size_t i = count; i > 1; --i)
      std::swap(ids[i - 1], ids[std::size_t(random.uniform() * double(i))]);
    std::iota(expected.begin(), expected.end(), 0u);
    std::sort(expected.begin(), expected.end(),
              [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
    EXPECT_EQ(order_by_id(ids.data(), count), expected);
  }
}

/// Ids of a forged checkpoint may be equal; the order still contains every particle once.
TEST(IdOrder, ContainsParticlesWithEqualIds) {
  const std::vector<std::uint32_t> ids{7, 7, 0, 4294967295u, 7};
  EXPECT_EQ(order_by_id(ids.data(), ids.size()), (std::vector<std::uint32_t>{2, 0, 1, 4, 3}));
}

}  // namespace
}  // namespace snowshed::particles
