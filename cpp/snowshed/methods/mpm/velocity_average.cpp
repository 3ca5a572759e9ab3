#include "snowshed/methods/mpm/velocity_average.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

/// The coarse grid is no finer than this part of a cell.
constexpr double min_spacing = 0.5;

int nodes_of_tile(int block_cells, double per_cell) {
  // The block with a cell of slack on either side, the nodes of a spline, and one node because the
  // block begins anywhere between coarse nodes.
  return int(std::ceil((block_cells + 2) * per_cell)) + 4;
}

}  // namespace

template <class T, int D>
VelocityAverage<T, D>::VelocityAverage(double length, double dx, Basis basis)
    : spacing_(std::max(length, min_spacing * dx)),
      per_cell_(dx / spacing_),
      share_of_length_(length * length / (spacing_ * spacing_)),
      slack_(1 - base_offset(basis)),
      tile_edge_(nodes_of_tile(block_edge<D>, per_cell_)),
      tile_size_(tile_edge_ * tile_edge_ * (D == 3 ? tile_edge_ : 1) * average_values) {
  const int across = (tile_edge_ + edge - 2) / edge + 1;  // coarse blocks that a tile may share
  around_size_ = across * across * (D == 3 ? across : 1);
}

template <class T, int D>
void VelocityAverage<T, D>::connect(const BlockLayout<D>& layout) {
  if (layout.particle_blocks != keys_ || tiles_of_.empty()) find_blocks(layout);
  std::fill(settled_.begin(), settled_.end(), std::uint8_t(0));
}

template <class T, int D>
void VelocityAverage<T, D>::find_blocks(const BlockLayout<D>& layout) {
  const std::size_t blocks = layout.particle_blocks.size();
  keys_ = layout.particle_blocks;
  tiles_.resize(blocks * std::size_t(tile_size_));
  tiles_of_.resize(blocks);
  first_nodes_.resize(blocks);
  settled_.resize(blocks);
  struct BlockShare {  // a particle block that shares a coarse block; fields share none
    int field;
    Coord coarse;
    std::int32_t block;
    auto key() const { return std::tie(field, coarse, block); }
    bool operator<(const BlockShare& other) const { return key() < other.key(); }
  };
  std::vector<BlockShare> pairs;
  for (std::size_t b = 0; b < blocks; ++b) {
    const BlockCoord<D> c = block_coord<D>(keys_[b]);
    AverageTile<T>& tile = tiles_of_[b];
    tile = {tiles_.data() + b * std::size_t(tile_size_), tile_edge_, T(per_cell_), {}, T(0)};
    Coord begin{}, end{};
    for (int d = 0; d < D; ++d) {
      const double origin = double(c[d]) * block_edge<D> * per_cell_;
      const double lowest = std::floor(origin - slack_ * per_cell_ - 0.5);
      first_nodes_[b][d] = std::int32_t(lowest);
      tile.origin[d] = T(origin - lowest);
      begin[d] = std::int32_t(std::floor(lowest / edge));
      end[d] = std::int32_t(std::floor((lowest + tile_edge_ - 1) / edge)) + 1;
    }
    for_each_index(begin, end, [&](const Coord& at) {
      pairs.push_back({field_of(keys_[b]), at, std::int32_t(b)});
    });
  }
  std::sort(pairs.begin(), pairs.end());
  coarse_blocks_.clear();
  sharing_.clear();
  sharing_first_.clear();
  around_.assign(blocks * std::size_t(around_size_), -1);
  std::vector<int> count(blocks, 0);
  int last_field = -1;
  for (const auto& [field, coarse, block] : pairs) {
    if (field != last_field || coarse_blocks_.back() != coarse) {
      last_field = field;
      coarse_blocks_.push_back(coarse);
      sharing_first_.push_back(std::int32_t(sharing_.size()));
    }
    sharing_.push_back(block);
    around_[std::size_t(block) * around_size_ + count[block]++] =
        std::int32_t(coarse_blocks_.size()) - 1;
  }
  sharing_first_.push_back(std::int32_t(sharing_.size()));
  sums_.resize(coarse_blocks_.size() * std::size_t(block_size));
  is_needed_.resize(coarse_blocks_.size());
  needed_.reserve(coarse_blocks_.size());
}

/// Calls row(node of the coarse block, node of the tile, length) for each run of nodes they share.
template <class T, int D>
template <class Row>
void VelocityAverage<T, D>::for_each_shared_row(std::int32_t coarse_block, std::int32_t block,
                                                Row row) const {
  // Range of the shared nodes within the coarse block.
  int low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, shift[3] = {0, 0, 0};
  for (int d = 0; d < D; ++d) {
    const int k = d + 3 - D;
    shift[k] = coarse_blocks_[coarse_block][d] * edge - first_nodes_[block][d];
    low[k] = std::max(0, -shift[k]);
    high[k] = std::min(edge, tile_edge_ - shift[k]);
  }
  for (int i = low[0]; i < high[0]; ++i)
    for (int j = low[1]; j < high[1]; ++j)
      row((i * edge + j) * edge + low[2],
          ((i + shift[0]) * tile_edge_ + j + shift[1]) * tile_edge_ + low[2] + shift[2],
          high[2] - low[2]);
}

template <class T, int D>
void VelocityAverage<T, D>::scatter(const Kernels<T>& kernels, const ParticleView<T>& view,
                                    const BlockLayout<D>& layout, std::int32_t b) noexcept {
  std::fill_n(tiles_of_[b].values, tile_size_, T(0));
  kernels.scatter_average(view, layout.first[b], layout.first[b + 1] - layout.first[b],
                          tiles_of_[b]);
}

template <class T, int D>
void VelocityAverage<T, D>::gather(std::int32_t c) noexcept {
  T* sums = sums_.data() + std::size_t(c) * block_size;
  std::fill_n(sums, block_size, T(0));
  for (std::int32_t i = sharing_first_[c]; i < sharing_first_[c + 1]; ++i) {
    const T* tile = tiles_of_[sharing_[i]].values;
    for_each_shared_row(c, sharing_[i], [&](int node, int tile_node, int length) {
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
  for (AverageTile<T>& tile : tiles_of_) tile.share = T(share * share_of_length_);
  parallel_for_dynamic(std::ptrdiff_t(states.size()), threads, 1, [&](std::ptrdiff_t b) {
    if (states[b].asleep && settled_[b]) return;
    scatter(kernels, view, layout, std::int32_t(b));
    settled_[b] = states[b].asleep;
  });
  std::fill(is_needed_.begin(), is_needed_.end(), std::uint8_t(0));
  for (const std::int32_t b : sleep.awake())
    for (int k = 0; k < around_size_; ++k) {
      const std::int32_t c = around_[std::size_t(b) * around_size_ + k];
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
  for (int k = 0; k < around_size_; ++k) {
    const std::int32_t c = around_[std::size_t(b) * around_size_ + k];
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
