// Which blocks of the grid exist, which particles belong to each, and who is whose neighbour.
// The grid is sparse and unbounded: only blocks that particles can reach are there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::mpm {

/// Integer position of a block; its first node is at coordinate * block_edge.
template <int D>
using BlockCoord = std::array<std::int32_t, D>;

/// A block's coordinates in one sortable number, 21 bits each.
using BlockKey = std::uint64_t;

inline constexpr std::int32_t block_coord_limit = (1 << 20) - 2;

template <int D>
BlockKey block_key(const BlockCoord<D>& c) {
  BlockKey key = 0;
  for (int d = 0; d < D; ++d) key = key << 21 | BlockKey(c[d] + (1 << 20));
  return key;
}

template <int D>
BlockCoord<D> block_coord(BlockKey key) {
  BlockCoord<D> c;
  for (int d = D - 1; d >= 0; --d, key >>= 21)
    c[d] = std::int32_t(key & ((1 << 21) - 1)) - (1 << 20);
  return c;
}

template <int D>
struct BlockLayout {
  static constexpr int neighbours = neighbour_count<D>;
  using Neighbours = std::array<std::int32_t, neighbours>;

  /// Blocks with particles, in ascending order; block i has the particles
  /// [first[i], first[i + 1]).
  std::vector<BlockKey> particle_blocks;
  std::vector<std::int32_t> first;

  /// Blocks with nodes that particles may reach: the above and all around them, ascending.
  std::vector<BlockKey> grid_blocks;

  /// For each particle block, the grid blocks around it (always present), lexicographic.
  std::vector<Neighbours> around_particles;
  /// For each grid block, the particle blocks around it, or -1.
  std::vector<Neighbours> around_nodes;

  /// The layout of other particle blocks.
  static BlockLayout of(std::vector<BlockKey> blocks, std::vector<std::int32_t> starts,
                        int threads);

  /// The same; cheaper where the blocks are those of this layout and only particles have moved.
  BlockLayout rearranged(std::vector<BlockKey> blocks, std::vector<std::int32_t> starts,
                         int threads) const;

 private:
  void connect(int threads);
};

}  // namespace snowshed::mpm
