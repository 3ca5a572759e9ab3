#include "snowshed/methods/mpm/average_layout.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

/// The coarse grid is no finer than this part of a cell.
constexpr double min_spacing = 0.5;

int nodes_of_tile(int block_cells, double slack, double per_cell) {
  // The block with its slack on either side, the nodes of a spline, and one node because the block
  // begins anywhere between coarse nodes.
  return int(std::ceil((block_cells + 2 * slack) * per_cell)) + 4;
}

}  // namespace

template <int D>
AverageLayout<D>::AverageLayout(double length, double dx, Basis basis, double slack)
    : slack_(slack - base_offset(basis)) {
  const double spacing = std::max(length, min_spacing * dx);
  per_cell_ = dx / spacing;
  share_of_length_ = length * length / (spacing * spacing);
  tile_edge_ = nodes_of_tile(block_edge<D>, slack, per_cell_);
  const int across = (tile_edge_ + edge - 2) / edge + 1;  // coarse blocks that a tile may share
  around_size_ = across * across * (D == 3 ? across : 1);
}

template <int D>
bool AverageLayout<D>::connect(const std::vector<BlockKey>& particle_blocks) {
  if (particle_blocks == keys_) return false;
  const std::size_t blocks = particle_blocks.size();
  keys_.clear();  // until all arrays belong to the new blocks
  first_nodes_.resize(blocks);
  origins_.resize(blocks);
  std::vector<BlockShare> pairs;
  for (std::size_t b = 0; b < blocks; ++b) {
    const BlockCoord<D> c = block_coord<D>(particle_blocks[b]);
    Coord begin{}, end{};
    for (int d = 0; d < D; ++d) {
      const double origin = double(c[d]) * block_edge<D> * per_cell_;
      const double lowest = std::floor(origin - slack_ * per_cell_ - 0.5);
      first_nodes_[b][d] = std::int32_t(lowest);
      origins_[b][d] = origin - lowest;
      begin[d] = std::int32_t(std::floor(lowest / edge));
      end[d] = std::int32_t(std::floor((lowest + tile_edge_ - 1) / edge)) + 1;
    }
    for_each_index(begin, end, [&](const Coord& at) {
      pairs.push_back({field_of(particle_blocks[b]), at, std::int32_t(b)});
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
  keys_ = particle_blocks;
  return true;
}

template class AverageLayout<2>;
template class AverageLayout<3>;

}  // namespace snowshed::methods::mpm
