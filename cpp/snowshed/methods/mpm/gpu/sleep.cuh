// The motion of blocks of particles, by which the host decides which of them sleep (sleep.hpp).
#pragma once

#include "snowshed/methods/mpm/gpu/tile.cuh"

namespace snowshed::methods::mpm::gpu {

inline constexpr int motion_threads = 64;

/// Adds what the nodes around a particle would do to it.
__device__ inline void add_carried(const float (&cell)[3], const GridArrays& grid,
                                   const std::int32_t* around, double mass, BlockMotion& m) {
  const Place place(cell);
  float w[3][3], g[3];
  for (int d = 0; d < 3; ++d) BSpline<Basis::quadratic>::evaluate(place.fraction[d], w[d], g);
  const GridNodes nodes{
      grid.velocity, grid.change, around, {place.lowest[0], place.lowest[1], place.lowest[2]}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        float node[taken_values];
        nodes.read(i, j, k, node);
        const double share = mass * double(w[0][i] * w[1][j] * w[2][k]);
        for (int d = 0; d < 3; ++d) {
          m.carried += share * double(node[d]) * double(node[d]);
          m.change[d] += share * double(node[3 + d]);
        }
      }
}

__device__ inline void join(BlockMotion& a, const BlockMotion& b) {
  a.speed_squared += b.speed_squared;
  a.mass += b.mass;
  a.carried += b.carried;
  for (int d = 0; d < 3; ++d) {
    a.velocity[d] += b.velocity[d];
    a.change[d] += b.change[d];
  }
  a.fastest = ::fmaxf(a.fastest, b.fastest);
  a.holds_its_snow = a.holds_its_snow && b.holds_its_snow;
}

}  // namespace snowshed::methods::mpm::gpu

extern "C" __global__ void __launch_bounds__(64)
    measure_motion(snowshed::methods::mpm::gpu::ParticleLaunch l,
                   snowshed::methods::mpm::gpu::BlockMotion* motions) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ BlockMotion shared[motion_threads];
  const int t = int(threadIdx.x), b = l.list[blockIdx.x];
  BlockMotion m{};
  m.holds_its_snow = 1;
  for (int i = l.blocks.first[b] + t; i < l.blocks.first[b + 1]; i += motion_threads) {
    float cell[3], squared = 0;
    for (int d = 0; d < 3; ++d) {
      cell[d] = l.particles.cell[d][i];
      const float v = l.particles.velocity[d][i];
      squared += v * v;
      m.velocity[d] += double(v);
      if (!(cell[d] >= 0.0f && cell[d] < float(edge))) m.holds_its_snow = 0;
    }
    m.speed_squared += double(squared);
    m.fastest = ::fmaxf(m.fastest, squared);
    const double mass = double(l.particles.mass[i]);
    m.mass += mass;
    add_carried(cell, l.grid, l.blocks.around + b * neighbours, mass, m);
  }
  shared[t] = m;
  for (int half = motion_threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t < half) join(shared[t], shared[t + half]);
  }
  if (t == 0) motions[b] = shared[0];
}

/// Stops the particles of the listed blocks.
extern "C" __global__ void __launch_bounds__(64)
    stop_blocks(snowshed::methods::mpm::gpu::ParticleLaunch l) {
  using namespace snowshed::methods::mpm::gpu;
  const int b = l.list[blockIdx.x];
  if (threadIdx.x == 0) l.fastest[b] = 0;
  for (int i = l.blocks.first[b] + int(threadIdx.x); i < l.blocks.first[b + 1];
       i += motion_threads) {
    for (int d = 0; d < 3; ++d) l.particles.velocity[d][i] = 0;
    for (int k = 0; k < 9 && l.particles.affine[0]; ++k) l.particles.affine[k][i] = 0;
  }
}

/// Nodes that only sleeping snow touches are at rest.
extern "C" __global__ void __launch_bounds__(64)
    clear_nodes(snowshed::methods::mpm::gpu::GridArrays grid, const std::int32_t* list) {
  using namespace snowshed::methods::mpm::gpu;
  const int block = list[blockIdx.x], t = int(threadIdx.x), n = block * nodes_of_block + t;
  grid.velocity[n] = {0, 0, 0, 0};
  grid.change[n] = {0, 0};
  if (t < 6) grid.ranges[block * 6 + t] = 0;
}
