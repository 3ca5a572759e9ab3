// The particles of each block that have moved to a block around it, and their new order: by blocks,
// and within a block as before. The host finds the new blocks from the counts.
#pragma once

#include "snowshed/methods/mpm/gpu/tile.cuh"

namespace snowshed::methods::mpm::gpu {

/// Returns the block around its own in which a particle lies.
__device__ inline int block_of(const ParticleArrays& p, int i) {
  int neighbour = 0;
  for (int d = 0; d < 3; ++d) {
    const float cell = p.cell[d][i];
    neighbour = neighbour * 3 + (cell < 0.0f ? 0 : cell < float(edge) ? 1 : 2);
  }
  return neighbour;
}

/// Makes a particle's `cell` refer to the block in which it lies (see particle_sort.cpp).
__device__ inline void rebase(const ParticleArrays& p, int i) {
  for (int d = 0; d < 3; ++d) {
    float& cell = p.cell[d][i];
    if (cell >= 0.0f && cell < float(edge)) continue;
    cell = cell < 0.0f ? cell + float(edge) : cell - float(edge);
    constexpr float largest = float(edge) * (1 - 6e-8f);
    if (cell >= float(edge)) cell = largest;  // rounded up
  }
}

template <class Value>
__device__ inline void permute_values(const Value* from, Value* to, const std::int32_t* order,
                                      int count) {
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) to[i] = from[order[i]];
}

}  // namespace snowshed::methods::mpm::gpu

/// Counts the particles of each block by the block around it in which they lie now.
extern "C" __global__ void __launch_bounds__(128)
    count_moves(snowshed::methods::mpm::gpu::ParticleArrays particles,
                snowshed::methods::mpm::gpu::BlockTable blocks, std::int32_t* counts) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ std::int32_t count[neighbours];
  const int t = int(threadIdx.x), b = int(blockIdx.x);
  if (t < neighbours) count[t] = 0;
  __syncthreads();
  for (int i = blocks.first[b] + t; i < blocks.first[b + 1]; i += int(blockDim.x))
    atomicAdd(&count[block_of(particles, i)], 1);
  __syncthreads();
  if (t < neighbours) counts[b * neighbours + t] = count[t];
}

/// Finds the order of the particles after the sort, and refers them to their new blocks. Those of
/// block b that lie in its neighbour k begin at starts[27 b + k].
extern "C" __global__ void __launch_bounds__(128)
    find_order(snowshed::methods::mpm::gpu::ParticleArrays particles,
               snowshed::methods::mpm::gpu::BlockTable blocks, const std::int32_t* starts,
               std::int32_t* order) {
  using namespace snowshed::methods::mpm::gpu;
  constexpr int threads = 128;
  __shared__ std::int32_t start[neighbours];
  __shared__ std::int8_t neighbour[threads];
  const int t = int(threadIdx.x), b = int(blockIdx.x), end = blocks.first[b + 1];
  if (t < neighbours) start[t] = starts[b * neighbours + t];
  for (int begin = blocks.first[b]; begin < end; begin += threads) {
    const int i = begin + t;
    neighbour[t] = i < end ? std::int8_t(block_of(particles, i)) : std::int8_t(-1);
    __syncthreads();
    int before = 0, all = 0;  // particles of the same neighbour among those of the threads
    if (t < neighbours)
      for (int other = 0; other < threads; ++other) all += neighbour[other] == t;
    if (i < end) {
      for (int other = 0; other < t; ++other) before += neighbour[other] == neighbour[t];
      order[start[neighbour[t]] + before] = i;
      rebase(particles, i);
    }
    __syncthreads();
    if (t < neighbours) start[t] += all;
    __syncthreads();
  }
}

extern "C" __global__ void permute4(const std::uint32_t* from, std::uint32_t* to,
                                    const std::int32_t* order, std::int32_t count) {
  snowshed::methods::mpm::gpu::permute_values(from, to, order, count);
}
extern "C" __global__ void permute2(const std::uint16_t* from, std::uint16_t* to,
                                    const std::int32_t* order, std::int32_t count) {
  snowshed::methods::mpm::gpu::permute_values(from, to, order, count);
}
extern "C" __global__ void permute1(const std::uint8_t* from, std::uint8_t* to,
                                    const std::int32_t* order, std::int32_t count) {
  snowshed::methods::mpm::gpu::permute_values(from, to, order, count);
}
