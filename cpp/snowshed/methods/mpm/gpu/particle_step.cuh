// The particle side of a step: a thread block to a block of particles. A thread takes a particle
// from the nodes through the law; then nine lanes sum the particles of one cell, each over a line
// of three nodes, in registers. Only these sums go to the tile, and those of the tile to the grid.
#pragma once

#include "snowshed/methods/mpm/gpu/particle.cuh"

namespace snowshed::methods::mpm::gpu {

/// Particles that a thread block treats at a time. Those with an affine velocity need more of the
/// shared memory, of which there are 48 kB.
template <bool affine>
inline constexpr int chunk = affine ? 128 : 256;

/// Numbers along x in a tile of sums. The odd stride avoids conflicts in shared memory.
inline constexpr int sum_stride = tile_edge * tile_edge + 3, sum_size = tile_edge * sum_stride;

template <bool affine>
struct StepMemory {
  union {
    struct {
      Quad velocity[tile_nodes];
      Pair change[tile_nodes];
    } nodes;
    int sums[node_sums][2][sum_size];  // high and low parts
  };
  GivenArrays<chunk<affine>, affine> given;
  std::int32_t around[neighbours];
  std::int32_t first[tile_cells];    // the first particle of each cell, or -1
  std::int16_t next[chunk<affine>];  // the next particle of the cell, or -1
  std::int16_t cells[tile_cells];    // those with particles
  std::int32_t cell_count;
  float fastest, spin;
};
static_assert(sizeof(StepMemory<true>) <= 48 * 1024 && sizeof(StepMemory<false>) <= 48 * 1024);

/// Puts the particles of a cell in ascending order, whatever the order in which threads came.
template <bool affine>
__device__ inline void sort_cell(StepMemory<affine>& m, int cell) {
  int sorted = -1;
  for (int q = m.first[cell], next; q >= 0; q = next) {
    next = m.next[q];
    if (sorted < 0 || q < sorted) {
      m.next[q] = std::int16_t(sorted);
      sorted = q;
      continue;
    }
    int before = sorted;
    while (m.next[before] >= 0 && m.next[before] < q) before = m.next[before];
    m.next[q] = m.next[before];
    m.next[before] = std::int16_t(q);
  }
  m.first[cell] = sorted;
}

template <bool affine>
__device__ inline void enter_cell(StepMemory<affine>& m, int q, const Place& place,
                                  const Given<affine>& given) {
  m.given.set(q, place.fraction, given);
  const int cell =
      (place.lowest[0] * tile_cells_edge + place.lowest[1]) * tile_cells_edge + place.lowest[2];
  m.next[q] = std::int16_t(atomicExch(&m.first[cell], q));
}

/// Sums the cells of a chunk into the tile, three cells to a warp.
template <bool affine>
__device__ inline void sum_cells(StepMemory<affine>& m, const Units& units) {
  const int warp = int(threadIdx.x) / 32, lane = int(threadIdx.x) % 32;
  const int cell_of_warp = lane / 9, line = lane % 9;
  if (cell_of_warp == 3) return;
  const NodeSpline of_x(line / 3), of_y(line % 3);
  for (int n = warp * 3 + cell_of_warp; n < m.cell_count; n += int(blockDim.x) / 32 * 3) {
    const int cell = m.cells[n];
    LineSums sums;
    for (int q = m.first[cell]; q >= 0; q = m.next[q]) sums.add(m.given, q, of_x, of_y);
    const int x = cell / (tile_cells_edge * tile_cells_edge) + line / 3;
    const int y = cell / tile_cells_edge % tile_cells_edge + line % 3, z = cell % tile_cells_edge;
    const int t = x * sum_stride + y * tile_edge + z;
#pragma unroll
    for (int k = 0; k < 3; ++k)
#pragma unroll
      for (int v = 0; v < node_sums; ++v)
        add_parts(&m.sums[v][0][t + k], &m.sums[v][1][t + k],
                  sums.node[k][v] * units.per[Units::kind(v)]);
  }
}

/// Adds the tile to the grid.
template <bool affine>
__device__ inline void add_tile(const StepMemory<affine>& m, unsigned long long* integers) {
  for (int t = int(threadIdx.x); t < tile_nodes; t += int(blockDim.x)) {
    const int at = (t >> 6) * sum_stride + (t & 63);
    if ((m.sums[0][0][at] | m.sums[0][1][at]) == 0) continue;  // no mass
    const int n = grid_node(t, m.around);
    for (int v = 0; v < node_sums; ++v)
      add_integer(integers + n * node_stride + v,
                  (long long)(m.sums[v][0][at]) * 65536 + m.sums[v][1][at]);
  }
}

/// Gives the particles of a chunk to the nodes, after `enter_cell`.
template <bool affine>
__device__ inline void give_chunk(StepMemory<affine>& m, const Units& units,
                                  unsigned long long* integers) {
  const int t = int(threadIdx.x), threads = int(blockDim.x);
  for (int i = t; i < node_sums * 2 * sum_size; i += threads) (&m.sums[0][0][0])[i] = 0;
  for (int c = t; c < tile_cells; c += threads) {
    if (m.first[c] < 0) continue;
    m.cells[atomicAdd(&m.cell_count, 1)] = std::int16_t(c);
    sort_cell(m, c);
  }
  __syncthreads();
  sum_cells(m, units);
  __syncthreads();
  add_tile(m, integers);
  __syncthreads();
}

template <bool affine>
__device__ inline void empty_cells(StepMemory<affine>& m) {
  for (int c = int(threadIdx.x); c < tile_cells; c += int(blockDim.x)) m.first[c] = -1;
  if (threadIdx.x == 0) m.cell_count = 0;
}

/// Returns the values that the nodes get from a particle that does not move.
template <class Variant>
__device__ inline Given<Variant::affine> give_at_rest(ParticleState<Variant>& s,
                                                      const ParticleLaunch& l, int i,
                                                      const Constants& k) {
  const MaterialConstants<float> snow = snow_of<Variant>(l.particles, i, k);
  const Strain tau = s.stress(snow, 0.0f, true).tau;
  s.record_kinetic(k.dx);
  s.record.write(l.energy, i);
  return s.given(tau, snow.specific_volume, float(k.dx));
}

/// Takes the particles of a block through a step. With `moves` false, only adds them to the sums.
template <class Variant, bool moves>
__device__ inline void step_block(const ParticleLaunch& l, Control* control, const Constants& k,
                                  StepMemory<Variant::affine>& m) {
  if (moves && control->phase != Phase::accepted) return;
  const int t = int(threadIdx.x), threads = int(blockDim.x), b = l.list[blockIdx.x];
  const int first = l.blocks.first[b], end = l.blocks.first[b + 1];
  if (t < neighbours) m.around[t] = l.blocks.around[b * neighbours + t];
  if (t == 0) m.fastest = m.spin = 0;
  const StepShares step(*control, k);
  const Units units(k, control->momentum_unit);
  Largest largest;
  constexpr int size = chunk<Variant::affine>;
  __syncthreads();
  for (int begin = first; begin < end; begin += size) {
    if (moves) load_tile(l.grid, m.around, m.nodes.velocity, m.nodes.change);
    empty_cells(m);
    __syncthreads();
    const int count = end - begin < size ? end - begin : size;
    for (int q = t; q < count; q += threads) {
      const int i = begin + q;
      ParticleState<Variant> s;
      s.read_cell(l.particles, i);
      if (!in_tile(s.cell)) {
        add_stray(l.strays, control, i);
        continue;
      }
      NodeMeans<Variant::affine> means;
      if (moves) {
        const Place from(s.cell);
        const int lowest =
            (from.lowest[0] * tile_edge + from.lowest[1]) * tile_edge + from.lowest[2];
        interpolate(from.fraction, TileNodes{m.nodes.velocity + lowest, m.nodes.change + lowest},
                    means);
      }
      s.read_rest(l.particles, i);
      if (moves) {
        move(s, means, l.average, b, step);
        if (!in_tile(s.cell)) {
          add_stray(l.strays, control, i);
          continue;
        }
        const auto moved = finish_particle(s, means, l.particles, i, k, step, control, largest);
        s.record.write(l.energy, i);
        if (moved.sound) enter_cell(m, q, Place(s.cell), moved.given);
      } else {
        enter_cell(m, q, Place(s.cell), give_at_rest(s, l, i, k));
      }
    }
    __syncthreads();
    give_chunk(m, units, l.integers);
  }
  if (!moves) return;
  raise(&m.fastest, largest.speed_squared);
  if (Variant::affine) raise(&m.spin, largest.spin);
  __syncthreads();
  if (t > 0) return;
  l.fastest[b] = m.fastest;
  raise(&control->speed_squared, m.fastest);
  if (Variant::affine) raise(&control->spin, m.spin);
}

/// Takes the strays through a step, a thread to a particle.
template <class Variant, bool moves>
__device__ inline void step_strays(const ParticleLaunch& l, std::int32_t block_count,
                                   Control* control, const Constants& k) {
  if (moves && control->phase != Phase::accepted) return;
  const StepShares step(*control, k);
  const Units units(k, control->momentum_unit);
  const int threads = int(gridDim.x * blockDim.x);
  Largest largest;
  for (int n = int(blockIdx.x * blockDim.x + threadIdx.x); n < control->strays; n += threads) {
    const int i = l.strays[n];
    int low = 0, high = block_count;  // the block is in [low, high)
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (l.blocks.first[middle] <= i ? low : high) = middle;
    }
    const std::int32_t* around = l.blocks.around + low * neighbours;
    ParticleState<Variant> s;
    s.read_cell(l.particles, i);
    s.read_rest(l.particles, i);
    if (moves) {
      const Place from(s.cell);
      NodeMeans<Variant::affine> means;
      interpolate(from.fraction,
                  GridNodes{l.grid.velocity,
                            l.grid.change,
                            around,
                            {from.lowest[0], from.lowest[1], from.lowest[2]}},
                  means);
      move(s, means, l.average, low, step);
      Largest own;
      const auto moved = finish_particle(s, means, l.particles, i, k, step, control, own);
      s.record.write(l.energy, i);
      raise(l.fastest + low, own.speed_squared);
      largest.speed_squared = ::fmaxf(largest.speed_squared, own.speed_squared);
      largest.spin = ::fmaxf(largest.spin, own.spin);
      if (!moved.sound) continue;
      if (!may_move_on(s.cell)) control->must_sort = 1;
      scatter_stray(Place(s.cell), moved.given, l.integers, around, units);
    } else {
      scatter_stray(Place(s.cell), give_at_rest(s, l, i, k), l.integers, around, units);
    }
  }
  if (moves && largest.speed_squared > 0) raise(&control->speed_squared, largest.speed_squared);
  if (moves && largest.spin > 0) raise(&control->spin, largest.spin);
}

}  // namespace snowshed::methods::mpm::gpu

/// Finds the largest component of an affine velocity.
extern "C" __global__ void __launch_bounds__(256)
    find_spin(snowshed::methods::mpm::gpu::ParticleArrays particles, std::int32_t count,
              snowshed::methods::mpm::gpu::Control* control) {
  using namespace snowshed::methods::mpm::gpu;
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= count) return;
  AffineVelocity<true> spin;
  spin.read(particles, i);
  const float largest = spin.largest();
  if (largest > control->spin) raise(&control->spin, largest);
}

// The kernels of a variant.
#define SNOWSHED_PARTICLE_KERNELS(suffix, several, affine, energy)                               \
  extern "C" __global__ void __launch_bounds__(128) particle_step##suffix(                       \
      snowshed::methods::mpm::gpu::ParticleLaunch l,                                             \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    __shared__ StepMemory<affine> memory;                                                        \
    step_block<Variant<several, affine, energy>, true>(l, control, k, memory);                   \
  }                                                                                              \
  extern "C" __global__ void __launch_bounds__(128) scatter##suffix(                             \
      snowshed::methods::mpm::gpu::ParticleLaunch l,                                             \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    __shared__ StepMemory<affine> memory;                                                        \
    step_block<Variant<several, affine, energy>, false>(l, control, k, memory);                  \
  }                                                                                              \
  extern "C" __global__ void __launch_bounds__(64) stray_step##suffix(                           \
      snowshed::methods::mpm::gpu::ParticleLaunch l, std::int32_t block_count,                   \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    step_strays<Variant<several, affine, energy>, true>(l, block_count, control, k);             \
  }                                                                                              \
  extern "C" __global__ void __launch_bounds__(64) scatter_strays##suffix(                       \
      snowshed::methods::mpm::gpu::ParticleLaunch l, std::int32_t block_count,                   \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    step_strays<Variant<several, affine, energy>, false>(l, block_count, control, k);            \
  }

SNOWSHED_PARTICLE_KERNELS(, false, false, false)
SNOWSHED_PARTICLE_KERNELS(_several, true, false, false)
SNOWSHED_PARTICLE_KERNELS(_affine, false, true, false)
SNOWSHED_PARTICLE_KERNELS(_several_affine, true, true, false)
