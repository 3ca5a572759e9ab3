// The largest velocity gradient that a step would impose on a particle. Derivatives of B-splines
// average the differences between nodes, so the range of the nodes' velocities bounds it: of all
// nodes, then of those around a block. Particles are examined only if these bounds are too large.
#pragma once

#include "snowshed/methods/mpm/gpu/particle_step.cuh"

namespace snowshed::methods::mpm::gpu {

struct ProbeMemory {
  Quad velocity[tile_nodes];
  Pair change[tile_nodes];
  std::int32_t around[neighbours];
  std::int32_t low[3], high[3];
};

/// Returns the largest component of a gradient; not a number if any is not.
__device__ inline float largest_component(const float (&gradient)[3][3]) {
  float largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const float size = ::fabsf(gradient[i][j]);
      if (!(size <= largest) && largest == largest) largest = size;
    }
  return largest;
}

/// Whether the range of the nodes around a block bounds the gradient well enough.
__device__ inline bool is_harmless(const GridArrays& grid, ProbeMemory& m, const Constants& k) {
  const int t = int(threadIdx.x);
  if (t < 3) {
    m.low[t] = ordered(3e38f);
    m.high[t] = ordered(-3e38f);
  }
  __syncthreads();
  if (t < neighbours)
    for (int d = 0; d < 3; ++d) {
      atomicMin(&m.low[d], ordered(grid.ranges[m.around[t] * 6 + d]));
      atomicMax(&m.high[d], ordered(grid.ranges[m.around[t] * 6 + 3 + d]));
    }
  __syncthreads();
  float low[3], high[3];
  for (int d = 0; d < 3; ++d) {
    low[d] = from_ordered(m.low[d]);
    high[d] = from_ordered(m.high[d]);
  }
  return bound_from_range(low, high, k.dx) <= harmless_gradient(k);
}

}  // namespace snowshed::methods::mpm::gpu

extern "C" __global__ void __launch_bounds__(128)
    probe(snowshed::methods::mpm::gpu::ParticleLaunch l,
          snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ ProbeMemory m;
  if (control->phase != Phase::trying) return;
  if (bound_of_all(*control, k.dx) <= harmless_gradient(k)) return;
  const int t = int(threadIdx.x), b = l.list[blockIdx.x];
  if (t < neighbours) m.around[t] = l.blocks.around[b * neighbours + t];
  __syncthreads();
  if (is_harmless(l.grid, m, k)) return;
  load_tile(l.grid, m.around, m.velocity, m.change);
  __syncthreads();
  float largest = 0;
  for (int i = l.blocks.first[b] + t; i < l.blocks.first[b + 1]; i += int(blockDim.x)) {
    float cell[3];
    for (int d = 0; d < 3; ++d) cell[d] = l.particles.cell[d][i];
    const Place from(cell);
    NodeMeans<false> means;
    if (in_tile(cell)) {
      const int lowest = (from.lowest[0] * tile_edge + from.lowest[1]) * tile_edge + from.lowest[2];
      interpolate(from.fraction, TileNodes{m.velocity + lowest, m.change + lowest}, means);
    } else {
      interpolate(from.fraction,
                  GridNodes{l.grid.velocity,
                            l.grid.change,
                            m.around,
                            {from.lowest[0], from.lowest[1], from.lowest[2]}},
                  means);
    }
    const float size = largest_component(means.gradient);
    if (!(size <= largest) && largest == largest) largest = size;
  }
  raise(&control->strain, largest / float(k.dx));
}
