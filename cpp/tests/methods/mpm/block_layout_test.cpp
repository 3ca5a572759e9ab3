#include "snowshed/methods/mpm/block_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "snowshed/core/random.hpp"

namespace snowshed::methods::mpm {
namespace {

TEST(BlockKey, OrdersAndRestoresCoordinates) {
  const BlockCoord<3> coordinates[] = {
      {0, 0, 0}, {-1, 2, -3}, {block_coord_limit(0), -block_coord_limit(0), 7}};
  for (const auto& c : coordinates) EXPECT_EQ(block_coord<3>(block_key<3>(c)), c);
  const BlockCoord<2> flat{-block_coord_limit(0), block_coord_limit(0)};
  EXPECT_EQ(block_coord<2>(block_key<2>(flat)), flat);
  EXPECT_LT(block_key<3>({-1, 5, 5}), block_key<3>({0, -5, -5}));  // lexicographic
  EXPECT_LT(block_key<3>({0, 0, -1}), block_key<3>({0, 0, 0}));
}

template <class Dimension>
class BlockLayoutTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BlockLayoutTest, Dimensions);

/// Expects that the layout has the right neighbours for all blocks.
template <int D>
void expect_connected(const BlockLayout<D>& layout, const std::set<BlockKey>& keys) {
  const std::vector<BlockKey>& blocks = layout.particle_blocks;
  std::set<BlockKey> expected;
  const auto around = [](BlockKey key, int n) {
    BlockCoord<D> c = block_coord<D>(key);
    for (int d = D - 1; d >= 0; --d, n /= 3) c[d] += n % 3 - 1;
    return block_key<D>(c);
  };
  for (BlockKey key : blocks)
    for (int n = 0; n < neighbour_count<D>; ++n) expected.insert(around(key, n));
  EXPECT_EQ(layout.grid_blocks, std::vector<BlockKey>(expected.begin(), expected.end()));
  for (std::size_t i = 0; i < blocks.size(); ++i)
    for (int n = 0; n < neighbour_count<D>; ++n)
      EXPECT_EQ(layout.grid_blocks[layout.around_particles[i][n]], around(blocks[i], n));
  for (std::size_t i = 0; i < layout.grid_blocks.size(); ++i)
    for (int n = 0; n < neighbour_count<D>; ++n) {
      const BlockKey key = around(layout.grid_blocks[i], n);
      const std::int32_t neighbour = layout.around_nodes[i][n];
      if (keys.count(key))
        EXPECT_EQ(blocks[neighbour], key);
      else
        EXPECT_EQ(neighbour, -1);
    }
}

TYPED_TEST(BlockLayoutTest, ConnectsEveryBlockWithItsNeighbours) {
  constexpr int D = TypeParam::value;
  Random random(1);
  std::set<BlockKey> keys;
  while (keys.size() < 40) {
    BlockCoord<D> c;
    for (int d = 0; d < D; ++d) c[d] = int(random.uniform() * 6) - 3;
    keys.insert(block_key<D>(c));
    if (D == 2 && keys.size() == 30) break;  // 30 of 36 possible ones
  }
  std::vector<BlockKey> blocks(keys.begin(), keys.end());
  std::vector<std::int32_t> starts(blocks.size() + 1);
  for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = int(3 * i);
  const auto single = BlockLayout<D>::of({blocks[0]}, {0, 1}, 1);
  for (const BlockLayout<D>& before : {BlockLayout<D>::of(blocks, starts, 1), single}) {
    SCOPED_TRACE(before.first.size());  // the same blocks, or a single block
    const BlockLayout<D> layout = before.rearranged(blocks, starts, 2);
    EXPECT_EQ(layout.particle_blocks, blocks);
    EXPECT_EQ(layout.first, starts);
    expect_connected(layout, keys);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
