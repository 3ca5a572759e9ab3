#include "snowshed/methods/mpm/gpu/device_average.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

/// Cells by which particles may stray from their block before they are sorted, see `may_move_on`.
constexpr double slack = edge;

AverageBlock average_block(const AverageLayout<3>& layout, std::size_t b) {
  constexpr int edge_of_coarse = AverageLayout<3>::edge;
  static_assert(edge_of_coarse == edge && AverageLayout<3>::block_nodes == nodes_of_block);
  AverageBlock block{};
  for (int d = 0; d < 3; ++d) {
    const std::int32_t first = layout.first_node(b)[std::size_t(d)];
    block.origin[d] = float(layout.origin(b)[std::size_t(d)]);
    block.shift[d] = first & (edge - 1);  // also of a negative one
    block.count[d] = (block.shift[d] + layout.tile_edge() - 1) / edge + 1;
  }
  return block;
}

}  // namespace

DeviceAverage::DeviceAverage(snowshed::gpu::Device& device, const Settings& n)
    : blocks_(device), around_(device), integers_(device), asleep_(device), mean_(device) {
  if (n.damps_over_length()) layout_.emplace(n.damping_length, n.dx, n.basis, slack);
}

void DeviceAverage::connect(const State<float, 3>& state) {
  if (!layout_) return;
  layout_->connect(state.layout.particle_blocks);
  std::vector<AverageBlock> blocks;
  for (std::size_t b = 0; b < layout_->size(); ++b) blocks.push_back(average_block(*layout_, b));
  blocks_.upload(blocks);
  around_.upload(layout_->around());
  const std::size_t nodes = layout_->coarse_blocks().size() * nodes_of_block;
  mean_.resize(nodes);
  integers_.resize(nodes * average_sums);
  integers_.clear();
  if (!state.sleep.allowed()) return;
  asleep_.resize(nodes * average_sums);
  asleep_.clear();
}

AverageArrays DeviceAverage::view() const {
  if (!layout_) return {};
  return {blocks_.data(),
          around_.data(),
          layout_->around_size(),
          layout_->tile_edge(),
          float(layout_->per_cell()),
          integers_.data(),
          asleep_.size() > 0 ? asleep_.data() : nullptr,
          mean_.data()};
}

std::size_t DeviceAverage::bytes() const {
  return blocks_.bytes() + around_.bytes() + integers_.bytes() + asleep_.bytes() + mean_.bytes();
}

}  // namespace snowshed::methods::mpm::gpu
