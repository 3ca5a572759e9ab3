#include "snowshed/methods/mpm/particle_sort.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"

namespace snowshed {

template <int D>
Placement<D> Placement<D>::of(const VecD<D>& position, double dx, Basis basis) {
  Placement p;
  for (int d = 0; d < D; ++d) {
    const double x = position[d] / dx - base_offset(basis);
    const double block = std::floor(x / block_edge<D>);
    if (!(std::abs(block) < block_coord_limit))
      throw SimulationError(
          "a particle lies outside the addressable grid: " + std::to_string(position[d]) + " m");
    p.block[d] = std::int32_t(block);
    p.cell[d] = x - block * block_edge<D>;
  }
  return p;
}

namespace {

/// Moves a particle that has strayed beyond its block into the one it is in now.
template <class T, int D>
bool rebase(Particles<T, D>& particles, std::size_t i, BlockKey& block) {
  BlockCoord<D> c = block_coord<D>(block);
  bool moved = false;
  for (int d = 0; d < D; ++d) {
    T& x = particles.cell[d][i];
    if (x >= T(0) && x < T(block_edge<D>)) continue;
    const double shift = std::floor(double(x) / block_edge<D>);
    if (!(std::abs(shift) < block_coord_limit)) return false;
    c[d] += std::int32_t(shift);
    if (std::abs(c[d]) > block_coord_limit) return false;
    x = T(double(x) - shift * block_edge<D>);
    if (x >= T(block_edge<D>)) x = std::nextafter(T(block_edge<D>), T(0));  // rounded up
    moved = true;
  }
  if (moved) block = block_key<D>(c);
  return true;
}

/// Stable counting sort of the particles by block.
std::vector<std::uint32_t> order_by_block(const std::vector<BlockKey>& blocks,
                                          const std::vector<BlockKey>& unique,
                                          std::vector<std::int32_t>& first, int threads) {
  const std::ptrdiff_t n = std::ptrdiff_t(blocks.size());
  std::vector<std::uint32_t> slot(blocks.size());
  parallel_for_each(n, threads, [&](std::ptrdiff_t i) {
    slot[i] =
        std::uint32_t(std::lower_bound(unique.begin(), unique.end(), blocks[i]) - unique.begin());
  });
  first.assign(unique.size() + 1, 0);
  for (std::uint32_t s : slot) ++first[s + 1];
  for (std::size_t b = 0; b < unique.size(); ++b) first[b + 1] += first[b];
  std::vector<std::int32_t> next(first.begin(), first.end() - 1);
  std::vector<std::uint32_t> order(blocks.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) order[next[slot[i]]++] = std::uint32_t(i);
  return order;
}

std::vector<BlockKey> unique_blocks(const std::vector<BlockKey>& blocks) {
  std::vector<BlockKey> unique;
  BlockKey last = 0;
  for (BlockKey key : blocks)  // neighbours in memory mostly share a block
    if (unique.empty() || key != last) unique.push_back(last = key);
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  return unique;
}

}  // namespace

template <class T, int D>
bool sort_particles(Particles<T, D>& particles, std::vector<BlockKey> blocks,
                    BlockLayout<D>& layout, int threads) {
  std::atomic<std::int64_t> lost{-1};
  parallel_for_each(std::ptrdiff_t(blocks.size()), threads, [&](std::ptrdiff_t i) {
    if (!rebase(particles, std::size_t(i), blocks[i])) lost = i;
  });
  if (lost >= 0)
    throw SimulationError("particle " + std::to_string(particles.id[std::size_t(lost)]) +
                          " has left the addressable grid or is not finite");
  std::vector<BlockKey> unique = unique_blocks(blocks);
  std::vector<std::int32_t> first;
  const std::vector<std::uint32_t> order = order_by_block(blocks, unique, first, threads);
  if (!std::is_sorted(order.begin(), order.end())) particles.permute(order, threads);
  return layout.assign(std::move(unique), std::move(first), threads);
}

template <int D>
std::vector<BlockKey> blocks_of_particles(const BlockLayout<D>& layout) {
  std::vector<BlockKey> blocks(layout.first.empty() ? 0 : std::size_t(layout.first.back()));
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    std::fill(blocks.begin() + layout.first[b], blocks.begin() + layout.first[b + 1],
              layout.particle_blocks[b]);
  return blocks;
}

template struct Placement<2>;
template struct Placement<3>;
template bool sort_particles(Particles<float, 2>&, std::vector<BlockKey>, BlockLayout<2>&, int);
template bool sort_particles(Particles<float, 3>&, std::vector<BlockKey>, BlockLayout<3>&, int);
template bool sort_particles(Particles<double, 2>&, std::vector<BlockKey>, BlockLayout<2>&, int);
template bool sort_particles(Particles<double, 3>&, std::vector<BlockKey>, BlockLayout<3>&, int);
template std::vector<BlockKey> blocks_of_particles(const BlockLayout<2>&);
template std::vector<BlockKey> blocks_of_particles(const BlockLayout<3>&);

}  // namespace snowshed
