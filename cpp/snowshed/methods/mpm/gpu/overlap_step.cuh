// The grid side of a step where blocks of nodes of several events lie at the same position: a
// thread block to a position. The events act on each other after the forces and before the contact
// with obstacles.
#pragma once

#include "snowshed/methods/mpm/event_rule.hpp"
#include "snowshed/methods/mpm/gpu/node_step.cuh"

namespace snowshed::methods::mpm::gpu {

struct ExchangeMemory {
  float excess[nodes_of_block], capacity[nodes_of_block];  // N s
};

/// Adds up excess and capacity over the nodes.
__device__ inline void sum_up(ExchangeMemory& m) {
  const int t = int(threadIdx.x);
  for (int half = nodes_of_block / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t >= half) continue;
    m.excess[t] += m.excess[t + half];
    m.capacity[t] += m.capacity[t + half];
  }
  __syncthreads();
}

template <bool energy>
__device__ inline void push_node(const GridArrays& grid, int n, float per_mass,
                                 const EventImpulses<float, 3>& i, float rubbing,
                                 const EventNode& c, NodeRecord<energy>& record) {
  Quad& velocity = grid.velocity[n];
  float pushed[3], rubbed[3], after[3] = {velocity.x, velocity.y, velocity.z};
  for (int d = 0; d < 3; ++d) {
    pushed[d] = per_mass * i.push * c.normal[d];
    rubbed[d] = per_mass * rubbing * i.slip[d];
    after[d] += pushed[d] + rubbed[d];
  }
  velocity = {after[0], after[1], after[2], velocity.w};
  record.exchange(grid.carried[n], pushed, rubbed, after);
}

/// Exchanges the impulses between two fields. A part of the stored friction may suffice to stop a
/// node with little snow. The excess slows the nodes of the block that still slide.
template <bool energy>
__device__ inline void exchange(const GridArrays& grid, const EventArrays& events, int pair,
                                const NodeTry& node_try, ExchangeMemory& m,
                                NodeRecord<energy>& record) {
  const int t = int(threadIdx.x);
  EventNode& c = events.nodes[pair * nodes_of_block + t];
  if (node_try.first) c.impulse = c.next_impulse;  // the last step was taken
  const bool acts = c.touches || c.impulse > 0;
  if (__syncthreads_count(acts) == 0) return;
  const int first = events.blocks[events.pairs[pair].first] * nodes_of_block + t;
  const int second = events.blocks[events.pairs[pair].second] * nodes_of_block + t;
  const float masses[2] = {grid.carried[first].x, grid.carried[second].x};
  const Quad a = grid.velocity[first], b = grid.velocity[second];
  const float difference[3] = {a.x - b.x, a.y - b.y, a.z - b.z};
  EventImpulses<float, 3> i{};
  if (acts)
    i = event_impulses(node_try.rates, events.friction, masses[0], masses[1], difference, c);
  m.excess[t] = i.excess();
  m.capacity[t] = i.capacity();
  sum_up(m);
  if (!i.any()) return;
  const float rubbing = i.rubbing(used_share(m.excess[0], m.capacity[0]));
  push_node(grid, first, -1 / masses[0], i, rubbing, c, record);
  push_node(grid, second, 1 / masses[1], i, rubbing, c, record);
}

/// Finds the new velocities of the nodes at a position. The impulses between events are recorded
/// with the first of its blocks.
template <bool energy>
__device__ inline void step_overlap(const GridArrays& grid, const EventArrays& events, int overlap,
                                    const ContactArrays& contacts, const ForceArrays& forces,
                                    const EnergyArrays& all, Control* control, const Constants& k,
                                    ExchangeMemory& exchanged, NodeMemory<energy>& m) {
  if (control->phase != Phase::trying) return;
  const NodeTry node_try(*control, k);
  const int t = int(threadIdx.x);
  const int begin = events.first_block[overlap], end = events.first_block[overlap + 1];
  NodeRecord<energy> record;
  for (int e = begin; e < end; ++e) {
    float velocity[3];
    const int n = events.blocks[e] * nodes_of_block + t;
    accelerate(grid, n, node_try, k, velocity);
    grid.velocity[n] = {velocity[0], velocity[1], velocity[2], 0};
  }
  for (int pair = events.first_pair[overlap]; pair < events.first_pair[overlap + 1]; ++pair) {
    exchange(grid, events, pair, node_try, exchanged, record);
    __syncthreads();
  }
  for (int e = begin; e < end; ++e) {
    const int block = events.blocks[e], n = block * nodes_of_block + t;
    const Quad after = grid.velocity[n];
    float velocity[3] = {after.x, after.y, after.z};
    finish_block(grid, contacts, forces, block, node_try, grid.carried[n], velocity, all, m, record,
                 control);
    __syncthreads();
  }
}

}  // namespace snowshed::methods::mpm::gpu

// The step of the nodes at the listed positions, with the balance of energy or without it.
#define SNOWSHED_OVERLAP_KERNEL(name, energy)                                                    \
  extern "C" __global__ void __launch_bounds__(64) name(                                         \
      snowshed::methods::mpm::gpu::GridArrays grid,                                              \
      snowshed::methods::mpm::gpu::EventArrays events, const std::int32_t* list,                 \
      snowshed::methods::mpm::gpu::ContactArrays contacts,                                       \
      snowshed::methods::mpm::gpu::ForceArrays forces,                                           \
      snowshed::methods::mpm::gpu::EnergyArrays all,                                             \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    __shared__ NodeMemory<energy> memory;                                                        \
    __shared__ ExchangeMemory exchanged;                                                         \
    step_overlap<energy>(grid, events, list[blockIdx.x], contacts, forces, all, control, k,      \
                         exchanged, memory);                                                     \
  }

SNOWSHED_OVERLAP_KERNEL(overlap_step, false)
