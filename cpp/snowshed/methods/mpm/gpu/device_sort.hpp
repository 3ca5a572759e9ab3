// The plan of a sort on a device: it has counted the particles that moved from block to block.
#pragma once

#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"

namespace snowshed::methods::mpm::gpu {

struct SortPlan {
  std::vector<BlockKey> blocks;     // with particles, ascending
  std::vector<std::int32_t> first;  // particle of each, and their number
  /// Where the particles begin that go from block b to its neighbour k, at 27 b + k.
  std::vector<std::int32_t> starts;
  bool any_moves = false;
};

/// Plans a stable sort from the numbers of particles that lie in each of the blocks around their
/// own. Throws SimulationError if a particle has left the addressable grid.
SortPlan plan_sort(const BlockLayout<3>&, const std::vector<std::int32_t>& counts);

/// Counts these numbers.
void launch_moves(snowshed::gpu::Device&, const ParticleArrays&, const BlockTable&,
                  std::int32_t blocks, DeviceArray<std::int32_t>& counts);

}  // namespace snowshed::methods::mpm::gpu
