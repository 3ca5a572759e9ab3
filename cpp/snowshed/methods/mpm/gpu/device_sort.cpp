#include "snowshed/methods/mpm/gpu/device_sort.hpp"

#include <algorithm>
#include <cstdlib>

#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

/// The key of the k-th block around another.
BlockKey neighbour_key(BlockKey key, int k) {
  const int field = field_of(key);
  BlockCoord<3> c = block_coord<3>(key);
  for (int d = 2; d >= 0; --d, k /= 3) {
    c[std::size_t(d)] += k % 3 - 1;
    if (std::abs(c[std::size_t(d)]) > block_coord_limit(field))
      throw SimulationError("a particle has left the addressable grid");
  }
  return block_key<3>(c, field);
}

struct Move {
  BlockKey to;
  std::int32_t at, count;  // index into the counts; number of particles
};

}  // namespace

SortPlan plan_sort(const BlockLayout<3>& layout, const std::vector<std::int32_t>& counts) {
  SortPlan plan;
  std::vector<Move> moves;
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    for (int k = 0; k < neighbours; ++k) {
      const std::size_t at = b * neighbours + std::size_t(k);
      if (counts[at] == 0) continue;
      moves.push_back({neighbour_key(layout.particle_blocks[b], k), std::int32_t(at), counts[at]});
      plan.any_moves = plan.any_moves || k != neighbours / 2;
    }
  std::stable_sort(moves.begin(), moves.end(),
                   [](const Move& a, const Move& b) { return a.to < b.to; });
  plan.starts.assign(counts.size(), 0);
  std::int32_t next = 0;
  for (const Move& move : moves) {
    if (plan.blocks.empty() || plan.blocks.back() != move.to) {
      plan.blocks.push_back(move.to);
      plan.first.push_back(next);
    }
    plan.starts[std::size_t(move.at)] = next;
    next += move.count;
  }
  plan.first.push_back(next);
  return plan;
}

void launch_moves(snowshed::gpu::Device& device, const ParticleArrays& particles,
                  const BlockTable& blocks, std::int32_t count, DeviceArray<std::int32_t>& counts) {
  counts.resize(std::size_t(count) * neighbours);
  launch(device, "count_moves", {unsigned(count), particle_threads}, particles, blocks,
         counts.data());
}

}  // namespace snowshed::methods::mpm::gpu
