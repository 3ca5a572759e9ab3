// The record of the forces on obstacles: the impulses of each contact, of each block of nodes, and
// of each obstacle in each step.
#pragma once

#include "snowshed/methods/mpm/gpu/control.cuh"

namespace snowshed::methods::mpm::gpu {

inline constexpr int force_threads = 128;

/// Adds the values of the first threads of a block, a power of two, to that of thread 0.
template <int threads>
__device__ inline void sum_up(double (&values)[3][threads]) {
  const int t = int(threadIdx.x);
  for (int half = threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t < half)
      for (int d = 0; d < 3; ++d) values[d][t] += values[d][t + half];
  }
}

/// Records the impulse of a contact in a step, N s on the snow. The first try adds that of the step
/// before to its sum.
__device__ inline void record_impulse(ContactForce<float>& force, const float (&impulse)[3],
                                      bool first_try) {
  for (int d = 0; d < 3; ++d) {
    if (first_try) force.sum[d] += force.impulse[d];
    force.impulse[d] = impulse[d];
  }
}

}  // namespace snowshed::methods::mpm::gpu

/// Records a step that was accepted: its end, its length, and the impulse on the snow by each
/// obstacle, a thread block to an obstacle.
extern "C" __global__ void __launch_bounds__(128)
    record_forces(const std::int32_t* list, std::int32_t count,
                  snowshed::methods::mpm::gpu::ContactArrays contacts,
                  snowshed::methods::mpm::gpu::ForceArrays forces,
                  const snowshed::methods::mpm::gpu::Control* control) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ double sums[3][force_threads];
  if (control->phase != Phase::accepted) return;
  const int t = int(threadIdx.x), obstacle = int(blockIdx.x);
  double own[3] = {};
  for (int i = t; i < count; i += force_threads) {
    const int g = list[i], begin = contacts.first[g], end = contacts.first[g + 1];
    if (begin == end) continue;
    const int first = contacts.contacts[begin].obstacle;
    if (first == contacts.contacts[end - 1].obstacle) {  // the only one
      for (int d = 0; d < 3 && first == obstacle; ++d) own[d] += double(forces.blocks[g * 3 + d]);
      continue;
    }
    for (int c = begin; c < end; ++c)
      for (int d = 0; d < 3 && contacts.contacts[c].obstacle == obstacle; ++d)
        own[d] += double(forces.contacts[c].impulse[d]);
  }
  for (int d = 0; d < 3; ++d) sums[d][t] = own[d];
  sum_up(sums);
  if (t > 0) return;
  double* step = forces.steps + control->taken * recorded_values(int(gridDim.x));
  if (obstacle == 0) {
    step[0] = control->time + control->dt;
    step[1] = control->dt;
  }
  for (int d = 0; d < 3; ++d) step[2 + obstacle * 3 + d] = sums[d][0];
}

/// Finds the ranges of the cells in which the particles of the listed blocks lie.
extern "C" __global__ void __launch_bounds__(64)
    find_cell_ranges(snowshed::methods::mpm::gpu::ParticleLaunch l,
                     snowshed::methods::mpm::gpu::CellRange* ranges) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ CellRange range;
  const int t = int(threadIdx.x), b = l.list[blockIdx.x];
  if (t < 3) {
    range.low[t] = no_particle;
    range.high[t] = -no_particle;
  }
  __syncthreads();
  for (int i = l.blocks.first[b] + t; i < l.blocks.first[b + 1]; i += int(blockDim.x))
    for (int d = 0; d < 3; ++d) {
      const int cell = int(::floorf(l.particles.cell[d][i]));
      atomicMin(&range.low[d], cell);
      atomicMax(&range.high[d], cell);
    }
  __syncthreads();
  if (t == 0) ranges[b] = range;
}
