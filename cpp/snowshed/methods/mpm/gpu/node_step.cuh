// The grid side of a step: a thread block to a block of nodes. Velocities from the sums (thesis
// 1.2.9), then the contacts, those with one obstacle at a time.
#pragma once

#include "snowshed/methods/mpm/contact_rule.hpp"
#include "snowshed/methods/mpm/gpu/energy.cuh"
#include "snowshed/methods/mpm/gpu/forces.cuh"
#include "snowshed/methods/mpm/gpu/sums.cuh"

namespace snowshed::methods::mpm::gpu {

template <bool energy>
struct NodeMemory : RecordMemory<energy> {
  float velocity[3][nodes_of_block], mass[nodes_of_block];
  std::int32_t low[3], high[3];
  double impulse[3][nodes_of_block];  // of the contacts of a thread
};

/// Reads the sums of a node. The first try of a step takes them from the whole numbers, and clears
/// those of the awake snow for the next step.
__device__ inline void read_sums(const GridArrays& grid, int n, bool first_try, const Units& units,
                                 Quad& carried, Quad& force) {
  if (!first_try) {
    carried = grid.carried[n];
    force = grid.force[n];
    return;
  }
  unsigned long long* integers = grid.integers + n * node_stride;
  const unsigned long long* asleep = grid.asleep ? grid.asleep + n * node_stride : nullptr;
  float sums[node_sums];
#pragma unroll
  for (int v = 0; v < node_sums; ++v) {
    long long sum = (long long)(integers[v]);
    integers[v] = 0;
    if (asleep) sum += (long long)(asleep[v]);
    sums[v] = float(sum) * units.of[Units::kind(v)];
  }
  carried = {sums[0], sums[1], sums[2], sums[3]};
  force = {sums[4], sums[5], sums[6], 0};
  grid.carried[n] = carried;
  grid.force[n] = force;
}

/// The values of the present step that a node needs. The step may still turn out too long.
struct NodeTry {
  bool first;  // the first try of this step
  float dt;    // s
  FrictionRates<float> rates;
  Units units;  // of the sums

  __device__ NodeTry(const Control& c, const Constants& k)
      : first(!c.repeated),
        dt(float(c.dt)),
        rates{float(::fmin(1.0, c.dt / k.friction_memory)), float(c.dt / k.friction_reach)},
        units(k, c.momentum_unit) {}
};

__device__ inline bool has_snow(const Quad& carried) { return carried.x > min_node_mass<float>; }

/// Returns the mass and momentum of a node, and finds its velocity after the forces.
__device__ inline Quad accelerate(const GridArrays& grid, int n, const NodeTry& node_try,
                                  const Constants& k, float (&velocity)[3]) {
  Quad carried, force;
  read_sums(grid, n, node_try.first, node_try.units, carried, force);
  velocity[0] = velocity[1] = velocity[2] = 0;
  if (!has_snow(carried)) return carried;
  const float momentum[3] = {carried.y, carried.z, carried.w}, dt = node_try.dt;
  const float pull[3] = {force.x, force.y, force.z}, per_mass = dt / carried.x;
  for (int d = 0; d < 3; ++d) velocity[d] = momentum[d] / carried.x + pull[d] * per_mass;
  velocity[2] -= dt * k.gravity;
  return carried;
}

/// Applies a contact to the velocity of its node, in a block whose first node is `first_node`.
template <bool energy>
__device__ inline void hold(const GridArrays& grid, int first_node, const ContactArrays& contacts,
                            Contact<float>& c, const NodeTry& node_try, NodeMemory<energy>& m,
                            NodeRecord<energy>& record) {
  const float mass = m.mass[c.node];
  if (!(mass > min_node_mass<float> && (c.acts || c.normal_impulse > 0))) {
    c.next_normal_impulse = 0;
    return;
  }
  const int o = c.obstacle;
  float node[3];
  for (int d = 0; d < 3; ++d) node[d] = m.velocity[d][c.node];
  typename NodeRecord<energy>::Motion motion(grid, first_node + c.node, node, node_try.dt);
  if (Condition(contacts.conditions[o]) == Condition::sticky) {
    for (int d = 0; d < 3; ++d) node[d] = c.velocity[d];
    record.stick(motion, node);
  } else {
    const auto coefficient = [&](float, float) { return contacts.friction[o]; };
    const ContactOutcome<float> outcome =
        push_and_rub<3>(node_try.rates, c, mass, contacts.friction_shares[o], coefficient, node);
    record.push_and_rub(motion, node, c.normal, outcome);
  }
  for (int d = 0; d < 3; ++d) m.velocity[d][c.node] = node[d];
}

/// Applies a contact and records its impulse.
template <bool energy>
__device__ inline void hold_and_record(const GridArrays& grid, int first_node,
                                       const ContactArrays& contacts, const NodeTry& node_try,
                                       ContactForce<float>& force, Contact<float>& c,
                                       NodeMemory<energy>& m, NodeRecord<energy>& record) {
  float impulse[3];
  for (int d = 0; d < 3; ++d) impulse[d] = m.velocity[d][c.node];
  hold(grid, first_node, contacts, c, node_try, m, record);
  for (int d = 0; d < 3; ++d) {
    impulse[d] = m.mass[c.node] * (m.velocity[d][c.node] - impulse[d]);
    m.impulse[d][threadIdx.x] += double(impulse[d]);
  }
  record_impulse(force, impulse, node_try.first);
}

/// Applies the contacts of a block.
template <bool energy>
__device__ inline void hold_block(const GridArrays& grid, const ContactArrays& contacts,
                                  const ForceArrays& forces, int block, const NodeTry& node_try,
                                  NodeMemory<energy>& m, NodeRecord<energy>& record) {
  const int first_node = block * nodes_of_block;
  const int end = contacts.first[block + 1];
  for (int begin = contacts.first[block]; begin < end;) {
    const int own = begin + int(threadIdx.x);
    const bool same_obstacle =
        own < end && contacts.contacts[own].obstacle == contacts.contacts[begin].obstacle;
    if (same_obstacle) {
      Contact<float> c = contacts.contacts[own];
      if (node_try.first) c.normal_impulse = c.next_normal_impulse;  // the last step was taken
      if (forces.contacts)
        hold_and_record(grid, first_node, contacts, node_try, forces.contacts[own], c, m, record);
      else
        hold(grid, first_node, contacts, c, node_try, m, record);
      contacts.contacts[own].normal_impulse = c.normal_impulse;
      contacts.contacts[own].next_normal_impulse = c.next_normal_impulse;
    }
    begin += __syncthreads_count(same_obstacle);
  }
  if (!forces.contacts) return;
  sum_up(m.impulse);
  if (threadIdx.x == 0)
    for (int d = 0; d < 3; ++d) forces.blocks[block * 3 + d] = float(m.impulse[d][0]);
}

/// Records the range of the velocities of a block.
template <bool energy>
__device__ inline void record_range(const GridArrays& grid, int block, bool has_snow,
                                    const float (&velocity)[3], NodeMemory<energy>& m,
                                    Control* control) {
  const int t = int(threadIdx.x);
  if (has_snow)
    for (int d = 0; d < 3; ++d) {
      atomicMin(&m.low[d], ordered(velocity[d]));
      atomicMax(&m.high[d], ordered(velocity[d]));
    }
  __syncthreads();
  if (t >= 3) return;
  grid.ranges[block * 6 + t] = from_ordered(m.low[t]);
  grid.ranges[block * 6 + 3 + t] = from_ordered(m.high[t]);
  // Most blocks are within the range that is known already, and need no atomic operation.
  if (m.low[t] < control->low[t]) atomicMin(&control->low[t], m.low[t]);
  if (m.high[t] > control->high[t]) atomicMax(&control->high[t], m.high[t]);
}

/// Applies the contacts with obstacles to the velocities of a block, and writes them. `carried` and
/// `velocity` are those of the thread's node.
template <bool energy>
__device__ inline void finish_block(const GridArrays& grid, const ContactArrays& contacts,
                                    const ForceArrays& forces, int block, const NodeTry& node_try,
                                    const Quad& carried, float (&velocity)[3],
                                    const EnergyArrays& all, NodeMemory<energy>& m,
                                    NodeRecord<energy>& record, Control* control) {
  const int t = int(threadIdx.x), n = block * nodes_of_block + t;
  if (t < 3) {
    m.low[t] = ordered(3e38f);
    m.high[t] = ordered(-3e38f);
  }
  for (int d = 0; d < 3; ++d) {
    m.velocity[d][t] = velocity[d];
    m.impulse[d][t] = 0;
  }
  m.mass[t] = carried.x;
  __syncthreads();
  hold_block(grid, contacts, forces, block, node_try, m, record);
  float old[3] = {};
  if (has_snow(carried)) {
    const float momentum[3] = {carried.y, carried.z, carried.w};
    for (int d = 0; d < 3; ++d) {
      velocity[d] = m.velocity[d][t];
      old[d] = momentum[d] / carried.x;
    }
    record.end(grid, n, velocity, node_try.dt);
  }
  m.add_up_block(record, all.nodes, block);
  grid.velocity[n] = {velocity[0], velocity[1], velocity[2], velocity[0] - old[0]};
  grid.change[n] = {velocity[1] - old[1], velocity[2] - old[2]};
  record_range(grid, block, has_snow(carried), velocity, m, control);
}

/// Finds the new velocities of a block of nodes.
template <bool energy>
__device__ inline void step_nodes(const GridArrays& grid, int block, const ContactArrays& contacts,
                                  const ForceArrays& forces, const EnergyArrays& all,
                                  Control* control, const Constants& k, NodeMemory<energy>& m) {
  if (control->phase != Phase::trying) return;
  const NodeTry node_try(*control, k);
  const int n = block * nodes_of_block + int(threadIdx.x);
  float velocity[3];
  const Quad carried = accelerate(grid, n, node_try, k, velocity);
  NodeRecord<energy> record;
  finish_block(grid, contacts, forces, block, node_try, carried, velocity, all, m, record, control);
}

}  // namespace snowshed::methods::mpm::gpu

// The step of the listed blocks of nodes, with the balance of energy or without it.
#define SNOWSHED_NODE_KERNEL(name, energy)                                                       \
  extern "C" __global__ void __launch_bounds__(64) name(                                         \
      snowshed::methods::mpm::gpu::GridArrays grid, const std::int32_t* list,                    \
      snowshed::methods::mpm::gpu::ContactArrays contacts,                                       \
      snowshed::methods::mpm::gpu::ForceArrays forces,                                           \
      snowshed::methods::mpm::gpu::EnergyArrays all,                                             \
      snowshed::methods::mpm::gpu::Control* control, snowshed::methods::mpm::gpu::Constants k) { \
    using namespace snowshed::methods::mpm::gpu;                                                 \
    __shared__ NodeMemory<energy> memory;                                                        \
    step_nodes<energy>(grid, list[blockIdx.x], contacts, forces, all, control, k, memory);       \
  }

SNOWSHED_NODE_KERNEL(node_step, false)

/// Finds the share of friction that remains for each obstacle with slip, a thread block to an
/// obstacle; see Contacts::find_friction_shares.
extern "C" __global__ void __launch_bounds__(128)
    find_friction_shares(snowshed::methods::mpm::gpu::ContactArrays contacts, std::int32_t count,
                         float* shares, const snowshed::methods::mpm::gpu::Control* control) {
  using namespace snowshed::methods::mpm;
  using namespace snowshed::methods::mpm::gpu;
  constexpr int threads = 128;
  __shared__ float net[threads], pushes[threads];
  if (control->phase != Phase::trying || control->repeated) return;
  const int t = int(threadIdx.x), obstacle = int(blockIdx.x);
  float own_net = 0, own_pushes = 0;
  for (int i = t; i < count; i += threads) {
    const Contact<float>& c = contacts.contacts[i];
    if (c.obstacle != obstacle || c.release != Release::never) continue;
    own_net += c.next_normal_impulse;
    own_pushes += ::fmaxf(c.next_normal_impulse, 0.0f);
  }
  net[t] = own_net;
  pushes[t] = own_pushes;
  for (int half = threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t >= half) continue;
    net[t] += net[t + half];
    pushes[t] += pushes[t + half];
  }
  if (t == 0) shares[obstacle] = pushes[0] > 0 ? ::fmaxf(net[0], 0.0f) / pushes[0] : 1.0f;
}
