#include "snowshed/methods/mpm/block_layout.hpp"

#include <algorithm>
#include <utility>

#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Calls f(neighbour index, key) for the 3^D blocks around a block, including itself.
template <int D, class F>
void for_each_neighbour(BlockKey key, F f) {
  const BlockCoord<D> c = block_coord<D>(key);
  for (int n = 0; n < neighbour_count<D>; ++n) {
    BlockCoord<D> o = c;
    int rest = n;
    for (int d = D - 1; d >= 0; --d, rest /= 3) o[d] += rest % 3 - 1;
    f(n, block_key<D>(o, field_of(key)));
  }
}

}  // namespace

std::int32_t find_block(const std::vector<BlockKey>& sorted, BlockKey key) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), key);
  return at != sorted.end() && *at == key ? std::int32_t(at - sorted.begin()) : -1;
}

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
typename BlockLayout<D>::Neighbours BlockLayout<D>::nodes_around(std::int32_t grid_block) const {
  Neighbours around;
  for_each_neighbour<D>(grid_blocks[std::size_t(grid_block)], [&](int n, BlockKey key) {
    around[std::size_t(n)] = find_block(grid_blocks, key);
  });
  return around;
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
  parallel_for_dynamic(std::ptrdiff_t(particle_blocks.size()), threads, 64,
                       [this](std::ptrdiff_t i) {
                         for_each_neighbour<D>(particle_blocks[i], [this, i](int n, BlockKey k) {
                           around_particles[i][n] = find_block(grid_blocks, k);
                         });
                       });
  parallel_for_dynamic(std::ptrdiff_t(grid_blocks.size()), threads, 64, [this](std::ptrdiff_t i) {
    for_each_neighbour<D>(grid_blocks[i], [this, i](int n, BlockKey k) {
      around_nodes[i][n] = find_block(particle_blocks, k);
    });
  });
  find_overlaps();
}

template <int D>
void BlockLayout<D>::find_overlaps() {
  if (grid_blocks.empty() || field_of(grid_blocks.back()) == 0) return;  // one field
  std::vector<std::pair<BlockCoord<D>, std::int32_t>> by_coord;
  for (std::size_t g = 0; g < grid_blocks.size(); ++g)
    by_coord.push_back({block_coord<D>(grid_blocks[g]), std::int32_t(g)});
  std::sort(by_coord.begin(), by_coord.end());
  has_overlap.assign(grid_blocks.size(), 0);
  for (std::size_t i = 0, end; i < by_coord.size(); i = end) {
    end = i + 1;
    while (end < by_coord.size() && by_coord[end].first == by_coord[i].first) ++end;
    if (end - i < 2) continue;
    for (std::size_t k = i; k < end; ++k) {
      overlap_blocks.push_back(by_coord[k].second);
      has_overlap[by_coord[k].second] = 1;
    }
    overlap_first.push_back(std::int32_t(overlap_blocks.size()));
  }
  if (overlap_blocks.empty()) has_overlap.clear();
}

template struct BlockLayout<2>;
template struct BlockLayout<3>;

}  // namespace snowshed::methods::mpm
