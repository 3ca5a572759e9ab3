#include "snowshed/methods/mpm/block_layout.hpp"

#include <algorithm>

#include "snowshed/core/parallel.hpp"

namespace snowshed::mpm {
namespace {

/// Calls f(neighbour index, key) for the 3^D blocks around one, itself included.
template <int D, class F>
void for_each_neighbour(BlockKey key, F f) {
  const BlockCoord<D> c = block_coord<D>(key);
  for (int n = 0; n < neighbour_count<D>; ++n) {
    BlockCoord<D> o = c;
    int rest = n;
    for (int d = D - 1; d >= 0; --d, rest /= 3) o[d] += rest % 3 - 1;
    f(n, block_key<D>(o));
  }
}

std::int32_t find(const std::vector<BlockKey>& sorted, BlockKey key) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), key);
  return at != sorted.end() && *at == key ? std::int32_t(at - sorted.begin()) : -1;
}

}  // namespace

template <int D>
BlockLayout<D> BlockLayout<D>::of(std::vector<BlockKey> blocks, std::vector<std::int32_t> starts,
                                  int threads) {
  BlockLayout layout;
  layout.particle_blocks = std::move(blocks);
  layout.first = std::move(starts);
  layout.connect(threads);
  return layout;
}

template <int D>
BlockLayout<D> BlockLayout<D>::rearranged(std::vector<BlockKey> blocks,
                                          std::vector<std::int32_t> starts, int threads) const {
  if (blocks != particle_blocks) return of(std::move(blocks), std::move(starts), threads);
  BlockLayout layout = *this;
  layout.first = std::move(starts);
  return layout;
}

template <int D>
void BlockLayout<D>::connect(int threads) {
  grid_blocks.reserve(particle_blocks.size() * 4);
  for (BlockKey key : particle_blocks)
    for_each_neighbour<D>(key, [this](int, BlockKey k) { grid_blocks.push_back(k); });
  std::sort(grid_blocks.begin(), grid_blocks.end());
  grid_blocks.erase(std::unique(grid_blocks.begin(), grid_blocks.end()), grid_blocks.end());

  around_particles.resize(particle_blocks.size());
  around_nodes.resize(grid_blocks.size());
  parallel_for(std::ptrdiff_t(particle_blocks.size()), threads, 64, [this](std::ptrdiff_t i) {
    for_each_neighbour<D>(particle_blocks[i], [this, i](int n, BlockKey k) {
      around_particles[i][n] = find(grid_blocks, k);
    });
  });
  parallel_for(std::ptrdiff_t(grid_blocks.size()), threads, 64, [this](std::ptrdiff_t i) {
    for_each_neighbour<D>(grid_blocks[i], [this, i](int n, BlockKey k) {
      around_nodes[i][n] = find(particle_blocks, k);
    });
  });
}

template struct BlockLayout<2>;
template struct BlockLayout<3>;

}  // namespace snowshed::mpm
