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

__device__ inline void push_node(const GridArrays& grid, int n, float per_mass,
                                 const EventImpulses<float, 3>& i, float rubbing,
                                 const EventNode& c) {
  float change[3];
  for (int d = 0; d < 3; ++d)
    change[d] = per_mass * i.push * c.normal[d] + per_mass * rubbing * i.slip[d];
  Quad& velocity = grid.velocity[n];
  velocity.x += change[0];
  velocity.y += change[1];
  velocity.z += change[2];
}

/// Exchanges the impulses between two fields. A part of the stored friction may suffice to stop a
/// node with little snow. The excess slows the nodes of the block that still slide.
__device__ inline void exchange(const GridArrays& grid, const EventArrays& events, int pair,
                                bool first_try, const FrictionRates<float>& rates,
                                ExchangeMemory& m) {
  const int t = int(threadIdx.x);
  EventNode& c = events.nodes[pair * nodes_of_block + t];
  if (first_try) c.impulse = c.next_impulse;  // the last step was taken
  const bool acts = c.touches || c.impulse > 0;
  if (__syncthreads_count(acts) == 0) return;
  const int first = events.blocks[events.pairs[pair].first] * nodes_of_block + t;
  const int second = events.blocks[events.pairs[pair].second] * nodes_of_block + t;
  const float masses[2] = {grid.carried[first].x, grid.carried[second].x};
  const Quad a = grid.velocity[first], b = grid.velocity[second];
  const float difference[3] = {a.x - b.x, a.y - b.y, a.z - b.z};
  EventImpulses<float, 3> i{};
  if (acts) i = event_impulses(rates, events.friction, masses[0], masses[1], difference, c);
  m.excess[t] = i.excess();
  m.capacity[t] = i.capacity();
  sum_up(m);
  if (!i.any()) return;
  const float rubbing = i.rubbing(used_share(m.excess[0], m.capacity[0]));
  push_node(grid, first, -1 / masses[0], i, rubbing, c);
  push_node(grid, second, 1 / masses[1], i, rubbing, c);
}

}  // namespace snowshed::methods::mpm::gpu

/// Finds the new velocities of the nodes at the listed positions.
extern "C" __global__ void __launch_bounds__(64)
    overlap_step(snowshed::methods::mpm::gpu::GridArrays grid,
                 snowshed::methods::mpm::gpu::EventArrays events, const std::int32_t* list,
                 snowshed::methods::mpm::gpu::ContactArrays contacts,
                 snowshed::methods::mpm::gpu::ForceArrays forces,
                 snowshed::methods::mpm::gpu::Control* control,
                 snowshed::methods::mpm::gpu::Constants k) {
  using namespace snowshed::methods::mpm;
  using namespace snowshed::methods::mpm::gpu;
  __shared__ NodeMemory m;
  __shared__ ExchangeMemory exchanged;
  if (control->phase != Phase::trying) return;
  const NodeTry node_try(*control, k);
  const int overlap = list[blockIdx.x], t = int(threadIdx.x);
  const int begin = events.first_block[overlap], end = events.first_block[overlap + 1];
  for (int e = begin; e < end; ++e) {
    float velocity[3];
    const int n = events.blocks[e] * nodes_of_block + t;
    accelerate(grid, n, node_try, k, velocity);
    grid.velocity[n] = {velocity[0], velocity[1], velocity[2], 0};
  }
  for (int pair = events.first_pair[overlap]; pair < events.first_pair[overlap + 1]; ++pair) {
    exchange(grid, events, pair, node_try.first, node_try.rates, exchanged);
    __syncthreads();
  }
  for (int e = begin; e < end; ++e) {
    const int block = events.blocks[e], n = block * nodes_of_block + t;
    const Quad after = grid.velocity[n];
    float velocity[3] = {after.x, after.y, after.z};
    finish_block(grid, contacts, forces, block, node_try, grid.carried[n], velocity, m, control);
    __syncthreads();
  }
}
