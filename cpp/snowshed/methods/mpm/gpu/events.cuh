// The search for contacts between the snow of two events: a thread block to a pair of blocks of
// nodes at the same position. It needs the sums of a step before `node_step` reads them.
#pragma once

#include "snowshed/methods/mpm/contact_radius.hpp"
#include "snowshed/methods/mpm/event_rule.hpp"
#include "snowshed/methods/mpm/gpu/particle.cuh"

namespace snowshed::methods::mpm::gpu {

/// Nodes of a block and of the 27 blocks around it, whose masses a pair needs.
inline constexpr int padded_edge = 3 * edge;
inline constexpr int padded_nodes = padded_edge * padded_edge * padded_edge;
static_assert(normal_margin<3> == edge, "masses are those of the blocks around a block");
/// Nodes whose normals are smoothed into those of a block.
inline constexpr int normals_edge = edge + 2 * normal_smoothing<3>;
inline constexpr int normals_nodes = normals_edge * normals_edge * normals_edge;

struct SearchMemory {
  float mass[2][padded_nodes];
  double weighted[normals_nodes][3];  // normals times the product of the masses, or zero
  float normal[nodes_of_block][3];
  std::int32_t reach[2][nodes_of_block];  // of the two fields along the normal, see `ordered`
  bool shared[nodes_of_block];
  float fastest;  // m2/s2
  bool is_due;
};
static_assert(sizeof(SearchMemory) <= 48 * 1024);

/// The mass of a node before a step reads the sums.
__device__ inline float mass_of_node(const GridArrays& grid, int n, float unit) {
  long long sum = (long long)(grid.integers[n * node_stride]);
  if (grid.asleep) sum += (long long)(grid.asleep[n * node_stride]);
  return float(sum) * unit;
}

/// Finds the masses of a field around a block, whose 27 blocks of nodes are given.
__device__ inline void load_masses(const GridArrays& grid, const std::int32_t* around, float unit,
                                   float* mass) {
  for (int i = int(threadIdx.x); i < padded_nodes; i += int(blockDim.x)) {
    const int x = i / (padded_edge * padded_edge), y = i / padded_edge % padded_edge;
    const int z = i % padded_edge, block = around[x / edge * 9 + y / edge * 3 + z / edge];
    const int n = block * nodes_of_block + x % edge * 16 + y % edge * 4 + z % edge;
    mass[i] = block < 0 ? 0.0f : mass_of_node(grid, n, unit);
  }
}

__device__ inline void weigh_normals(SearchMemory& m) {
  for (int i = int(threadIdx.x); i < normals_nodes; i += int(blockDim.x)) {
    const int x = i / (normals_edge * normals_edge), y = i / normals_edge % normals_edge;
    const int z = i % normals_edge, at = ((x + 1) * padded_edge + y + 1) * padded_edge + z + 1;
    double (&normal)[3] = m.weighted[i];
    if (!is_shared(m.mass[0][at], m.mass[1][at]) ||
        !find_weighted_normal(m.mass[0] + at, m.mass[1] + at, padded_edge, normal))
      normal[0] = normal[1] = normal[2] = 0;
  }
}

/// Smooths the normals of the shared nodes of the block. A thread has a node.
__device__ inline void smooth_normals(SearchMemory& m) {
  const int t = int(threadIdx.x);
  if (t >= nodes_of_block || !m.shared[t]) return;
  constexpr int reach = normal_smoothing<3>;
  const int node[3] = {t >> 4, t >> 2 & 3, t & 3};
  double sum[3] = {};
  for (int i = 0; i <= 2 * reach; ++i)
    for (int j = 0; j <= 2 * reach; ++j)
      for (int k = 0; k <= 2 * reach; ++k) {
        const int distance[3] = {i - reach, j - reach, k - reach};
        const double weight = smoothing_weight(distance);
        const int at = ((node[0] + i) * normals_edge + node[1] + j) * normals_edge + node[2] + k;
        for (int d = 0; d < 3; ++d) sum[d] += weight * m.weighted[at][d];
      }
  const double length = ::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  m.shared[t] = length > 0;
  for (int d = 0; d < 3; ++d) m.normal[t][d] = m.shared[t] ? float(sum[d] / length) : 0.0f;
}

/// Finds how far a particle reaches along the normals of the shared nodes that it touches. `cell`
/// is relative to the block of nodes.
template <bool first>
__device__ inline void reach_from(const float (&cell)[3], float radius, SearchMemory& m) {
  int lowest[3];
  float x[3];
  for (int d = 0; d < 3; ++d) {
    lowest[d] = int(::floorf(cell[d]));
    if (lowest[d] < -2 || lowest[d] >= edge) return;
    x[d] = cell[d] + float(base_offset(Basis::quadratic));
  }
  const auto begin = [&](int d) { return lowest[d] > 0 ? lowest[d] : 0; };
  const auto end = [&](int d) { return lowest[d] + 3 < edge ? lowest[d] + 3 : edge; };
  for (int i = begin(0); i < end(0); ++i)
    for (int j = begin(1); j < end(1); ++j)
      for (int k = begin(2); k < end(2); ++k) {
        const int node = i * 16 + j * 4 + k;
        if (!m.shared[node]) continue;
        const float* normal = m.normal[node];
        const float along = x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2];
        if (first)
          atomicMax(&m.reach[0][node], ordered(along + radius));
        else
          atomicMin(&m.reach[1][node], ordered(along - radius));
      }
}

/// Finds how far the particles of a field reach, whose 27 blocks around the block are given.
template <bool first>
__device__ inline void find_reach(const EventArrays& events, const ParticleArrays& p,
                                  const BlockTable& blocks, const std::int32_t* around,
                                  SearchMemory& m) {
  for (int b = 0; b < neighbours; ++b) {
    if (around[b] < 0) continue;
    const float shift[3] = {float((b / 9 - 1) * edge), float((b / 3 % 3 - 1) * edge),
                            float((b % 3 - 1) * edge)};
    const int end = blocks.first[around[b] + 1];
    for (int i = blocks.first[around[b]] + int(threadIdx.x); i < end; i += int(blockDim.x)) {
      float cell[3];
      for (int d = 0; d < 3; ++d) cell[d] = p.cell[d][i] + shift[d];
      reach_from<first>(cell, events.radius[i], m);
    }
  }
}

/// Finds the contacts of a pair, which keep their stored impulses. A node at which the snow has
/// separated stays a contact until friction has used up its stored impulse.
__device__ inline void search_pair(const EventArrays& events, const ParticleLaunch& l,
                                   const EventPair& pair, EventNode* nodes, float unit,
                                   SearchMemory& m) {
  const int t = int(threadIdx.x);
  const std::int32_t* around[2] = {events.nodes_around + pair.first * neighbours,
                                   events.nodes_around + pair.second * neighbours};
  bool shared = false;
  if (t < nodes_of_block) {
    float mass[2];
    for (int f = 0; f < 2; ++f)
      mass[f] = mass_of_node(l.grid, around[f][neighbours / 2] * nodes_of_block + t, unit);
    m.shared[t] = shared = is_shared(mass[0], mass[1]);
    m.reach[0][t] = ordered(-1e9f);
    m.reach[1][t] = ordered(1e9f);
  }
  if (__syncthreads_count(shared) > 0) {
    for (int f = 0; f < 2; ++f) load_masses(l.grid, around[f], unit, m.mass[f]);
    __syncthreads();
    weigh_normals(m);
    __syncthreads();
    smooth_normals(m);
    __syncthreads();
    find_reach<true>(events, l.particles, l.blocks,
                     events.particles_around + pair.first * neighbours, m);
    find_reach<false>(events, l.particles, l.blocks,
                      events.particles_around + pair.second * neighbours, m);
    __syncthreads();
  }
  if (t >= nodes_of_block) return;
  EventNode node{};
  if (m.shared[t]) {
    node.touches = from_ordered(m.reach[0][t]) >= from_ordered(m.reach[1][t]);
    for (int d = 0; d < 3; ++d) node.normal[d] = m.normal[t][d];
    const float stored = nodes[t].next_impulse;
    if (node.touches || stored > 0) node.impulse = node.next_impulse = stored;
  }
  nodes[t] = node;
}

/// Whether the snow that can reach a pair's nodes may have moved far enough since their contacts
/// were sought: in the last step, and before.
__device__ inline bool is_search_due(const EventArrays& events, const ParticleLaunch& l, int pair,
                                     double dt, double tolerance, SearchMemory& m) {
  const int t = int(threadIdx.x);
  if (t == 0) m.fastest = 0;
  __syncthreads();
  float fastest = 0;
  if (t < 2 * neighbours) {
    const std::int32_t block =
        t < neighbours ? events.pairs[pair].first : events.pairs[pair].second;
    const std::int32_t b = events.particles_around[block * neighbours + t % neighbours];
    if (b >= 0) fastest = l.fastest[b];
  }
  raise(&m.fastest, fastest);
  __syncthreads();
  if (t == 0) {
    const double travel = events.travel[pair] + double(::sqrtf(m.fastest)) * dt;
    m.is_due = travel >= tolerance;
    events.travel[pair] = m.is_due ? 0 : travel;
  }
  __syncthreads();
  return m.is_due;
}

}  // namespace snowshed::methods::mpm::gpu

/// Finds the contacts of the listed pairs. A search within a step (`control` is not null) is due
/// only if snow may have moved far enough.
extern "C" __global__ void __launch_bounds__(128)
    find_event_contacts(snowshed::methods::mpm::gpu::EventArrays events,
                        snowshed::methods::mpm::gpu::ParticleLaunch l,
                        const snowshed::methods::mpm::gpu::Control* control,
                        snowshed::methods::mpm::gpu::Constants k) {
  using namespace snowshed::methods::mpm::gpu;
  __shared__ SearchMemory memory;
  if (control && (control->phase != Phase::trying || control->repeated)) return;
  const int pair = l.list[blockIdx.x];
  if (control && !is_search_due(events, l, pair, control->last_dt, k.event_tolerance, memory))
    return;
  search_pair(events, l, events.pairs[pair], events.nodes + pair * nodes_of_block,
              Units(k, 1.0f).of[0], memory);
}

/// Finds the radii of the particles in contacts, in cells.
extern "C" __global__ void __launch_bounds__(256)
    find_radii(snowshed::methods::mpm::gpu::ParticleArrays p, std::int32_t count,
               const snowshed::methods::mpm::gpu::InitialSnow* snows, double share, double dx,
               float* radius) {
  using namespace snowshed::methods::mpm;
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= count) return;
  const gpu::InitialSnow snow = snows[p.material_id ? p.material_id[i] : 0];
  snowshed::material::Sym<double, 3> a;
  for (int c = 0; c < 6; ++c) a.c[c] = double(p.be_minus_identity[c][i]);
  const double plastic = p.plastic ? double(p.plastic[i]) : 0.0;
  const double ratio = volume_ratio<3>(a, plastic, snow.plastic_strain);
  radius[i] = float(contact_radius<3>(share, double(p.mass[i]) / snow.density, ratio) / dx);
}
