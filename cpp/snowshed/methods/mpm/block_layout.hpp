// Blocks of the grid that exist, the particles that belong to each, and the neighbours of each. The
// grid is sparse and unbounded: it has only blocks that particles can reach.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::methods::mpm {

/// Integer position of a block; its first node is at coordinate * block_edge.
template <int D>
using BlockCoord = std::array<std::int32_t, D>;

/// A block's coordinates and its velocity field in one sortable number. A key of the field 0, the
/// only field of most runs, has 21 bits for each coordinate. A key of another field has the highest
/// bit set, 6 bits for the field, and 19 bits for each coordinate. Blocks with the same coordinates
/// and different fields are different blocks. Neighbours have the same field.
using BlockKey = std::uint64_t;

inline constexpr int max_fields = 64;

/// Bits of a coordinate.
constexpr int coord_bits(int field) { return field == 0 ? 21 : 19; }

/// The largest magnitude of a coordinate.
constexpr std::int32_t block_coord_limit(int field) { return (1 << (coord_bits(field) - 1)) - 2; }

constexpr int field_of(BlockKey key) { return key >> 63 ? int(key >> 57 & (max_fields - 1)) : 0; }

template <int D>
BlockKey block_key(const BlockCoord<D>& c, int field = 0) {
  const int bits = coord_bits(field);
  BlockKey key = 0;
  for (int d = 0; d < D; ++d) key = key << bits | BlockKey(c[d] + (1 << (bits - 1)));
  return field == 0 ? key : key | BlockKey(max_fields + field) << 57;
}

template <int D>
BlockCoord<D> block_coord(BlockKey key) {
  const int bits = coord_bits(field_of(key));
  BlockCoord<D> c;
  for (int d = D - 1; d >= 0; --d, key >>= bits)
    c[d] = std::int32_t(key & ((BlockKey(1) << bits) - 1)) - (1 << (bits - 1));
  return c;
}

/// Returns the index of a block in a sorted list, or -1.
std::int32_t find_block(const std::vector<BlockKey>& sorted, BlockKey key);

template <int D>
struct BlockLayout {
  static constexpr int neighbours = neighbour_count<D>;
  using Neighbours = std::array<std::int32_t, neighbours>;

  /// Blocks with particles, in ascending order; block i has the particles
  /// [first[i], first[i + 1]).
  std::vector<BlockKey> particle_blocks;
  std::vector<std::int32_t> first;

  /// Blocks with nodes that particles may reach: the particle blocks and all blocks around them,
  /// ascending.
  std::vector<BlockKey> grid_blocks;

  /// For each particle block, the grid blocks around it in lexicographic order. All of them exist.
  std::vector<Neighbours> around_particles;
  /// For each grid block, the particle blocks around it in the same order, or -1 if there is none.
  std::vector<Neighbours> around_nodes;

  /// An overlap is a position at which several fields have blocks of nodes. Overlap i has the grid
  /// blocks overlap_blocks[k], overlap_first[i] <= k < overlap_first[i + 1]. `has_overlap` has a
  /// flag for each grid block: whether it belongs to an overlap. It is empty without overlaps.
  std::vector<std::int32_t> overlap_first{0}, overlap_blocks;
  std::vector<std::uint8_t> has_overlap;

  /// Returns the layout of the given particle blocks.
  static BlockLayout of(std::vector<BlockKey> blocks, std::vector<std::int32_t> starts,
                        int threads);

  /// Returns the same layout as `of`. This is cheaper if only particles have moved and the blocks
  /// are those of this layout.
  BlockLayout rearranged(std::vector<BlockKey> blocks, std::vector<std::int32_t> starts,
                         int threads) const;

  /// The blocks of nodes around one of them, of the same field, in lexicographic order; -1 if there
  /// is none.
  Neighbours nodes_around(std::int32_t grid_block) const;

 private:
  void connect(int threads);
  void find_overlaps();
};

}  // namespace snowshed::methods::mpm
