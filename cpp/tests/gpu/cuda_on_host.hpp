// The parts of CUDA that kernels use, on a processor. A fiber plays a thread; the threads of a
// block run one after the other from barrier to barrier, so that shared memory needs no lock.
// Include this before the kernels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#define __global__
#define __device__
#define __shared__ static
#define __launch_bounds__(...)

namespace snowshed::gpu::emulation {

struct Index {
  unsigned x;
};
/// The indices of the thread that runs, and the size of its launch.
extern Index thread, block, threads_of_block, blocks_of_grid;

/// Lets the other threads of the block run up to here. Returns the number of those whose `flag` is
/// set.
int wait_for_block(bool flag);

}  // namespace snowshed::gpu::emulation

#define threadIdx snowshed::gpu::emulation::thread
#define blockIdx snowshed::gpu::emulation::block
#define blockDim snowshed::gpu::emulation::threads_of_block
#define gridDim snowshed::gpu::emulation::blocks_of_grid

inline void __syncthreads() { snowshed::gpu::emulation::wait_for_block(false); }
inline int __syncthreads_count(bool flag) { return snowshed::gpu::emulation::wait_for_block(flag); }

inline int __float_as_int(float x) {
  int bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline float __int_as_float(int bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

template <class Value>
Value atomicAdd(Value* at, Value amount) {
  const Value before = *at;
  // Whole numbers wrap, as on a card.
  *at = Value(std::uint64_t(before) + std::uint64_t(amount));
  return before;
}
template <class Value>
Value atomicExch(Value* at, Value value) {
  return std::exchange(*at, value);
}
template <class Value>
Value atomicMax(Value* at, Value value) {
  const Value before = *at;
  *at = std::max(before, value);
  return before;
}
template <class Value>
Value atomicMin(Value* at, Value value) {
  const Value before = *at;
  *at = std::min(before, value);
  return before;
}
