// The balance of energy: the energies of each particle and of each block of nodes, and their sums
// over a step. Sums have a fixed order, so that every run has the same bits.
#pragma once

#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/basis.hpp"
#include "snowshed/methods/mpm/energy_rule.hpp"
#include "snowshed/methods/mpm/gpu/control.cuh"

namespace snowshed::methods::mpm::gpu {

inline constexpr int energy_threads = 128;

/// Adds the values of the threads of a block, a power of two, to that of thread 0.
template <class Energies, int threads>
__device__ inline void add_up(Energies (&values)[threads]) {
  const int t = int(threadIdx.x);
  for (int half = threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t < half) values[t] += values[t + half];
  }
}

/// The energies of a particle; without the balance, nothing.
template <bool energy>
struct ParticleRecord {
  ParticleEnergies energies{};

  __device__ void add_return(const material::PQ<float>& trial, const material::PQ<float>& now,
                             const material::Elasticity<float>& elastic, double volume) {
    add_strain_energy(volume, elastic.bulk, elastic.mu, {trial.p, trial.q}, {now.p, now.q},
                      energies);
  }
  /// Before `change` is added to the velocity.
  __device__ void add_damping(float mass, const float (&velocity)[3], const float (&change)[3]) {
    for (int d = 0; d < 3; ++d)
      energies.damping -=
          double(mass) * double(change[d]) * (double(velocity[d]) + 0.5 * double(change[d]));
  }
  /// `gradient` is that of the node velocities, per cell.
  __device__ void add_stress_power(double volume, const material::Sym<float, 3>& tau,
                                   const float (&gradient)[3][3], double dx) {
    float work = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) work += tau(i, j) * gradient[i][j];
    energies.stress_power -= volume * double(work) / dx;
  }
  /// `spin_squared` is the sum of the squares of the affine velocity, s^-2.
  __device__ void add_kinetic(float mass, const float (&velocity)[3], double spin_squared,
                              double dx) {
    double squared = dx * dx / apic_inverse_inertia(Basis::quadratic) * spin_squared;
    for (const float v : velocity) squared += double(v) * double(v);
    energies.kinetic += 0.5 * double(mass) * squared;
  }
  __device__ void write(const EnergyArrays& all, int i) const { all.particles[i] = energies; }
};
template <>
struct ParticleRecord<false> {
  __device__ void add_return(const material::PQ<float>&, const material::PQ<float>&,
                             const material::Elasticity<float>&, double) {}
  __device__ void add_damping(float, const float (&)[3], const float (&)[3]) {}
  __device__ void add_stress_power(double, const material::Sym<float, 3>&, const float (&)[3][3],
                                   double) {}
  __device__ void add_kinetic(float, const float (&)[3], double, double) {}
  __device__ void write(const EnergyArrays&, int) const {}
};

/// The energies of the nodes of a thread; without the balance, nothing.
template <bool energy>
struct NodeRecord {
  NodeEnergies energies{};

  /// Begins the record of a contact, before it acts on `velocity`.
  struct Motion : NodeMotion<float, 3> {
    __device__ Motion(const GridArrays& grid, int n, const float (&velocity)[3], float dt) {
      const Quad carried = grid.carried[n], stresses = grid.force[n];
      const float momentum[3] = {carried.y, carried.z, carried.w};
      const float force[3] = {stresses.x, stresses.y, stresses.z};
      mass = carried.x;
      for (int d = 0; d < 3; ++d) {
        impulse[d] = double(dt) * double(force[d]);
        before[d] = momentum[d] / mass;
        free[d] = velocity[d];
      }
    }
    __device__ void end(const float (&velocity)[3]) {
      for (int d = 0; d < 3; ++d) after[d] = velocity[d];
    }
  };
  __device__ void stick(Motion& m, const float (&velocity)[3]) {
    m.end(velocity);
    add_sticking(m, energies);
  }
  __device__ void push_and_rub(Motion& m, const float (&velocity)[3], const float (&normal)[3],
                               const ContactOutcome<float>& outcome) {
    m.end(velocity);
    add_push_and_rub(m, normal, outcome, energies);
  }
  /// Impulses between two events that act on one of them; `after` is its velocity then.
  __device__ void exchange(const Quad& carried, const float (&pushed)[3], const float (&rubbed)[3],
                           const float (&after)[3]) {
    const float momentum[3] = {carried.y, carried.z, carried.w};
    for (int d = 0; d < 3; ++d)
      add_exchange(double(carried.x), double(momentum[d]), double(pushed[d]), double(rubbed[d]),
                   double(after[d]), energies);
  }
  /// A node at the end of the step being tried.
  __device__ void end(const GridArrays& grid, int n, const float (&velocity)[3], float dt) {
    const Quad carried = grid.carried[n], stresses = grid.force[n];
    const float momentum[3] = {carried.y, carried.z, carried.w};
    const float force[3] = {stresses.x, stresses.y, stresses.z};
    add_node_energy<3>(carried.x, momentum, force, velocity, dt, energies);
  }
};
template <>
struct NodeRecord<false> {
  struct Motion {
    __device__ Motion(const GridArrays&, int, const float (&)[3], float) {}
  };
  __device__ void stick(Motion&, const float (&)[3]) {}
  __device__ void push_and_rub(Motion&, const float (&)[3], const float (&)[3],
                               const ContactOutcome<float>&) {}
  __device__ void exchange(const Quad&, const float (&)[3], const float (&)[3],
                           const float (&)[3]) {}
  __device__ void end(const GridArrays&, int, const float (&)[3], float) {}
};

/// Room for the records of the threads of a block.
template <bool energy>
struct RecordMemory {
  NodeEnergies energies[nodes_of_block];

  /// Adds up the records, and begins new ones.
  __device__ void add_up_block(NodeRecord<true>& record, NodeEnergies* sums, int block) {
    energies[threadIdx.x] = record.energies;
    add_up(energies);
    if (threadIdx.x == 0) sums[block] = energies[0];
    record = {};
  }
};
template <>
struct RecordMemory<false> {
  __device__ void add_up_block(NodeRecord<false>&, NodeEnergies*, int) {}
};

}  // namespace snowshed::methods::mpm::gpu
