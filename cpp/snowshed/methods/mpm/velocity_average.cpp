#include "snowshed/methods/mpm/velocity_average.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Cells by which particles may stray from their block before they are sorted.
constexpr double slack = 1;

}  // namespace

template <class T, int D>
VelocityAverage<T, D>::VelocityAverage(double length, double dx, Basis basis)
    : layout_(length, dx, basis, slack), offset_(base_offset(basis)) {
  const int tile_edge = layout_.tile_edge();
  tile_size_ = tile_edge * tile_edge * (D == 3 ? tile_edge : 1) * average_values;
}

template <class T, int D>
void VelocityAverage<T, D>::connect(const BlockLayout<D>& layout) {
  if (layout_.connect(layout.particle_blocks)) tiles_fit_ = false;
  if (!tiles_fit_) find_tiles();
  tiles_fit_ = true;
  std::fill(settled_.begin(), settled_.end(), std::uint8_t(0));
}

template <class T, int D>
void VelocityAverage<T, D>::find_tiles() {
  const std::size_t blocks = layout_.size();
  tiles_.resize(blocks * std::size_t(tile_size_));
  tiles_of_.resize(blocks);
  boxes_.resize(blocks);
  settled_.resize(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    AverageTile<T>& tile = tiles_of_[b];
    tile = {tiles_.data() + b * std::size_t(tile_size_),
            layout_.tile_edge(),
            T(layout_.per_cell()),
            {},
            T(0)};
    for (int d = 0; d < D; ++d) tile.origin[d] = T(layout_.origin(b)[d]);
  }
  const std::size_t coarse_blocks = layout_.coarse_blocks().size();
  sums_.resize(coarse_blocks * std::size_t(block_size));
  is_needed_.resize(coarse_blocks);
  needed_.reserve(coarse_blocks);
}

template <class T, int D>
typename VelocityAverage<T, D>::Box VelocityAverage<T, D>::reached_box(const ParticleView<T>& view,
                                                                       const BlockLayout<D>& layout,
                                                                       std::int32_t b) const {
  constexpr double rounding = 1e-3;  // more than the error of the kernel's positions, spacings
  const int last = layout_.tile_edge() - support(Basis::quadratic);
  Box box;
  for (int d = 0; d < D; ++d) {
    const T* const cell = view.cell[d];
    T low = cell[layout.first[b]], high = low;
    for (std::int32_t i = layout.first[b] + 1; i < layout.first[b + 1]; ++i) {
      low = std::min(low, cell[i]);
      high = std::max(high, cell[i]);
    }
    const auto lowest_node = [&](double at) {
      return (at + offset_) * layout_.per_cell() + layout_.origin(std::size_t(b))[d] - 0.5;
    };
    box.begin[d] = std::clamp(int(std::floor(lowest_node(low) - rounding)), 0, last);
    box.end[d] = std::clamp(int(std::floor(lowest_node(high) + rounding)), 0, last) +
                 support(Basis::quadratic);
  }
  return box;
}

/// Calls row(node of the coarse block, node of the tile, length) for each run of nodes they share
/// and the particles of the tile reach.
template <class T, int D>
template <class Row>
void VelocityAverage<T, D>::for_each_shared_row(std::int32_t coarse_block, std::int32_t block,
                                                Row row) const {
  // Range of the shared nodes within the coarse block.
  int low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, shift[3] = {0, 0, 0};
  for (int d = 0; d < D; ++d) {
    const int k = d + 3 - D;
    shift[k] = layout_.coarse_blocks()[coarse_block][d] * edge - layout_.first_node(block)[d];
    low[k] = std::max(0, boxes_[block].begin[d] - shift[k]);
    high[k] = std::min(edge, boxes_[block].end[d] - shift[k]);
    if (low[k] >= high[k]) return;
  }
  for (int i = low[0]; i < high[0]; ++i)
    for (int j = low[1]; j < high[1]; ++j)
      row((i * edge + j) * edge + low[2],
          ((i + shift[0]) * layout_.tile_edge() + j + shift[1]) * layout_.tile_edge() + low[2] +
              shift[2],
          high[2] - low[2]);
}

template <class T, int D>
void VelocityAverage<T, D>::scatter(const Kernels<T>& kernels, const ParticleView<T>& view,
                                    const BlockLayout<D>& layout, std::int32_t b) noexcept {
  boxes_[b] = reached_box(view, layout, b);
  int begin[3] = {0, 0, 0}, end[3] = {1, 1, 1};
  for (int d = 0; d < D; ++d) {
    begin[d + 3 - D] = boxes_[b].begin[d];
    end[d + 3 - D] = boxes_[b].end[d];
  }
  const int row = layout_.tile_edge();
  for (int i = begin[0]; i < end[0]; ++i)
    for (int j = begin[1]; j < end[1]; ++j)
      std::fill_n(tiles_of_[b].values + ((i * row + j) * row + begin[2]) * average_values,
                  (end[2] - begin[2]) * average_values, T(0));
  kernels.scatter_average(view, layout.first[b], layout.first[b + 1] - layout.first[b],
                          tiles_of_[b]);
}

template <class T, int D>
void VelocityAverage<T, D>::gather(std::int32_t c) noexcept {
  T* sums = sums_.data() + std::size_t(c) * block_size;
  std::fill_n(sums, block_size, T(0));
  const std::vector<std::int32_t>& first = layout_.sharing_first();
  for (std::int32_t i = first[c]; i < first[c + 1]; ++i) {
    const std::int32_t block = layout_.sharing()[i];
    const T* tile = tiles_of_[block].values;
    for_each_shared_row(c, block, [&](int node, int tile_node, int length) {
      for (int k = 0; k < length * average_values; ++k)
        sums[node * average_values + k] += tile[tile_node * average_values + k];
    });
  }
  for (int k = 0; k < block_size; k += average_values) {
    const T mass = sums[k];
    for (int d = 0; d < D; ++d) sums[k + 1 + d] = mass > T(1e-30) ? sums[k + 1 + d] / mass : T(0);
  }
}

template <class T, int D>
void VelocityAverage<T, D>::update(const Kernels<T>& kernels, const ParticleView<T>& view,
                                   const BlockLayout<D>& layout, const Sleep<D>& sleep,
                                   double share, int threads) noexcept {
  const auto& states = sleep.states();
  for (AverageTile<T>& tile : tiles_of_) tile.share = T(share * layout_.share_of_length());
  parallel_for_dynamic(std::ptrdiff_t(states.size()), threads, 1, [&](std::ptrdiff_t b) {
    if (states[b].asleep && settled_[b]) return;
    scatter(kernels, view, layout, std::int32_t(b));
    settled_[b] = states[b].asleep;
  });
  std::fill(is_needed_.begin(), is_needed_.end(), std::uint8_t(0));
  for (const std::int32_t b : sleep.awake())
    for (int k = 0; k < layout_.around_size(); ++k) {
      const std::int32_t c = layout_.around()[std::size_t(b) * layout_.around_size() + k];
      if (c >= 0) is_needed_[c] = 1;
    }
  needed_.clear();
  for (std::size_t c = 0; c < is_needed_.size(); ++c)
    if (is_needed_[c]) needed_.push_back(std::int32_t(c));
  parallel_for_dynamic(std::ptrdiff_t(needed_.size()), threads, 8,
                       [&](std::ptrdiff_t i) { gather(needed_[i]); });
}

template <class T, int D>
const AverageTile<T>& VelocityAverage<T, D>::tile(std::int32_t b) {
  AverageTile<T>& tile = tiles_of_[b];
  for (int k = 0; k < layout_.around_size(); ++k) {
    const std::int32_t c = layout_.around()[std::size_t(b) * layout_.around_size() + k];
    if (c < 0) break;
    const T* sums = sums_.data() + std::size_t(c) * block_size;
    for_each_shared_row(c, b, [&](int node, int tile_node, int length) {
      std::copy_n(sums + node * average_values, length * average_values,
                  tile.values + tile_node * average_values);
    });
  }
  return tile;
}

template class VelocityAverage<float, 2>;
template class VelocityAverage<float, 3>;
template class VelocityAverage<double, 2>;
template class VelocityAverage<double, 3>;

}  // namespace snowshed::methods::mpm
