#include "snowshed/methods/mpm/particle_sort.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mpm {

template <int D>
Placement<D> Placement<D>::of(const VecD<D>& position, double dx, Basis basis, int field) {
  Placement p;
  for (int d = 0; d < D; ++d) {
    const double x = position[d] / dx - base_offset(basis);
    const double block = std::floor(x / block_edge<D>);
    if (!(std::abs(block) < block_coord_limit(field)))
      throw SimulationError(
          "a particle lies outside the addressable grid: " + std::to_string(position[d]) + " m");
    p.block[d] = std::int32_t(block);
    p.cell[d] = x - block * block_edge<D>;
  }
  return p;
}

namespace {

template <class T, int D>
bool lies_within(T x) {
  return x >= T(0) && x < T(block_edge<D>);
}

/// Returns the number of blocks by which a cell coordinate lies beyond its own block.
template <class T, int D>
double blocks_beyond(T x) {
  return std::floor(double(x) / block_edge<D>);
}

/// Returns the block in which a particle lies, or nothing beyond the addressable grid. The
/// particle's `cell` refers to `block`.
template <class T, int D>
std::optional<BlockKey> present_block(const Particles<T, D>& particles, std::size_t i,
                                      BlockKey block) {
  BlockCoord<D> c = block_coord<D>(block);
  const int field = field_of(block);
  bool moved = false;
  for (int d = 0; d < D; ++d) {
    const T x = particles.cell[d][i];
    if (lies_within<T, D>(x)) continue;
    const double beyond = blocks_beyond<T, D>(x);
    if (!(std::abs(beyond) < block_coord_limit(field))) return std::nullopt;
    c[d] += std::int32_t(beyond);
    if (std::abs(c[d]) > block_coord_limit(field)) return std::nullopt;
    moved = true;
  }
  return moved ? block_key<D>(c, field) : block;
}

/// Makes a particle's `cell` refer to the block in which the particle lies.
template <class T, int D>
void rebase(Particles<T, D>& particles, std::size_t i) {
  for (int d = 0; d < D; ++d) {
    T& x = particles.cell[d][i];
    if (lies_within<T, D>(x)) continue;
    x = T(double(x) - blocks_beyond<T, D>(x) * block_edge<D>);
    if (x >= T(block_edge<D>)) x = std::nextafter(T(block_edge<D>), T(0));  // rounded up
  }
}

/// Stable counting sort of the particles by block.
std::vector<std::uint32_t> order_by_block(const std::vector<BlockKey>& blocks,
                                          const std::vector<BlockKey>& unique,
                                          std::vector<std::int32_t>& first, int threads) {
  const std::ptrdiff_t n = std::ptrdiff_t(blocks.size());
  std::vector<std::uint32_t> slot(blocks.size());
  parallel_for_static(n, threads, [&](std::ptrdiff_t i) {
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
ParticleSort<T, D>::ParticleSort(const Particles<T, D>& particles, std::vector<BlockKey> blocks,
                                 const BlockLayout<D>& present, int threads)
    : threads_(threads) {
  parallel_for_static(std::ptrdiff_t(blocks.size()), threads, [&](std::ptrdiff_t i) {
    const auto block = present_block(particles, std::size_t(i), blocks[i]);
    if (!block)
      throw SimulationError("particle " + std::to_string(particles.id[std::size_t(i)]) +
                            " has left the addressable grid or is not finite");
    blocks[i] = *block;
  });
  std::vector<BlockKey> unique = unique_blocks(blocks);
  std::vector<std::int32_t> first;
  order_ = order_by_block(blocks, unique, first, threads);
  if (std::is_sorted(order_.begin(), order_.end())) order_.clear();
  spare_ = particles.spare(order_.size());
  layout = present.rearranged(std::move(unique), std::move(first), threads);
}

template <class T, int D>
void ParticleSort<T, D>::apply(Particles<T, D>& particles) noexcept {
  parallel_for_static(std::ptrdiff_t(particles.size()), threads_,
                      [&](std::ptrdiff_t i) { rebase(particles, std::size_t(i)); });
  if (!order_.empty()) particles.permute(order_, spare_, threads_);
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
template class ParticleSort<float, 2>;
template class ParticleSort<float, 3>;
template class ParticleSort<double, 2>;
template class ParticleSort<double, 3>;
template std::vector<BlockKey> blocks_of_particles(const BlockLayout<2>&);
template std::vector<BlockKey> blocks_of_particles(const BlockLayout<3>&);

}  // namespace snowshed::methods::mpm
