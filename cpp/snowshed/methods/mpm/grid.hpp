// The grid's arrays: a tile of sums for each block with particles, and for each grid block the
// gathered sums and the velocities.
#pragma once

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"

namespace snowshed::methods::mpm {

template <class T, int D>
struct Grid {
  int tile_size;  // values per tile
  AlignedVector<T> tiles, sums, velocities;
  std::vector<BlockStats> block_stats;  // per particle block
  std::vector<NodeStats> node_stats;    // per grid block
  std::vector<std::uint8_t> touched;    // per grid block: whether any particle reaches it

  static constexpr int block_size = block_nodes<D> * node_values;

  explicit Grid(Basis basis) : tile_size(tile_nodes<D>(basis) * node_values) {}

  void resize(const BlockLayout<D>& layout) {
    const std::size_t blocks = layout.particle_blocks.size(), nodes = layout.grid_blocks.size();
    make_room(tiles, blocks * tile_size);
    make_room(sums, nodes * block_size);
    make_room(velocities, nodes * block_size);
    block_stats.resize(blocks);
    node_stats.resize(nodes);
    touched.resize(nodes);
  }

  /// Resizes an array without keeping its values, all of which are computed again after a change of
  /// layout.
  static void make_room(AlignedVector<T>& values, std::size_t n) {
    if (n > values.capacity()) {
      AlignedVector<T>().swap(values);
      values.reserve(n + n / 8);  // doubling would waste memory
    }
    values.resize(n);
  }

  /// Finds the tiles that reach a grid block, among those of the particle blocks around it. The
  /// other entries become null. Returns whether any tile reaches the block.
  bool tiles_reaching(const BlockLayout<D>& layout, std::size_t grid_block,
                      const T* (&reaching)[neighbour_count<D>]) {
    bool any = false;
    for (int k = 0; k < neighbour_count<D>; ++k) {
      const std::int32_t block = layout.around_nodes[grid_block][k];
      // Seen from the particle block, the grid block is the opposite neighbour.
      constexpr int last = neighbour_count<D> - 1;
      const bool reached = block >= 0 && reaches<D>(block_stats[block].reach, last - k);
      reaching[k] = reached ? tile(std::size_t(block)) : nullptr;
      any = any || reached;
    }
    return any;
  }

  T* tile(std::size_t block) { return tiles.data() + block * tile_size; }
  T* sum(std::size_t block) { return sums.data() + block * block_size; }
  T* velocity(std::size_t block) { return velocities.data() + block * block_size; }

  std::size_t bytes() const {
    return (tiles.capacity() + sums.capacity() + velocities.capacity()) * sizeof(T);
  }
};

}  // namespace snowshed::methods::mpm
