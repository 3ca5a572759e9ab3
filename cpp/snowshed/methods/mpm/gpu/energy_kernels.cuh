// All kernels, those with the balance of energy included. They are compiled only where it is kept,
// because compilation takes seconds.
#pragma once

#include "snowshed/methods/mpm/gpu/kernels.cuh"

SNOWSHED_NODE_KERNEL(node_step_energy, true)
SNOWSHED_OVERLAP_KERNEL(overlap_step_energy, true)
// With the balance of energy, each particle has a snow of its own.
SNOWSHED_PARTICLE_KERNELS(_several_energy, true, false, true)
SNOWSHED_PARTICLE_KERNELS(_several_affine_energy, true, true, true)

/// Adds up the energies of the particles of the listed blocks, a thread block to each: after a step
/// that was accepted, or after `scatter` (`control` is null).
extern "C" __global__ void __launch_bounds__(128)
    add_particle_energies(const std::int32_t* list, const std::int32_t* first,
                          snowshed::methods::mpm::gpu::EnergyArrays all,
                          const snowshed::methods::mpm::gpu::Control* control) {
  using namespace snowshed::methods::mpm;
  using namespace snowshed::methods::mpm::gpu;
  __shared__ ParticleEnergies sums[energy_threads];
  if (control && control->phase != Phase::accepted) return;
  const int t = int(threadIdx.x), b = list[blockIdx.x];
  ParticleEnergies own{};
  for (int i = first[b] + t; i < first[b + 1]; i += energy_threads) own += all.particles[i];
  sums[t] = own;
  add_up(sums);
  if (t == 0) all.blocks[b] = sums[0];
}

/// Records the energies of a step that was accepted: over all blocks of particles, also sleeping
/// ones, and over the listed blocks of nodes.
extern "C" __global__ void __launch_bounds__(128)
    record_energies(const std::int32_t* list, std::int32_t node_blocks,
                    std::int32_t particle_blocks, snowshed::methods::mpm::gpu::EnergyArrays all,
                    const snowshed::methods::mpm::gpu::Control* control) {
  using namespace snowshed::methods::mpm;
  using namespace snowshed::methods::mpm::gpu;
  __shared__ ParticleEnergies of_particles[energy_threads];
  __shared__ NodeEnergies of_nodes[energy_threads];
  if (control->phase != Phase::accepted) return;
  const int t = int(threadIdx.x);
  ParticleEnergies particles{};
  for (int b = t; b < particle_blocks; b += energy_threads) particles += all.blocks[b];
  NodeEnergies nodes{};
  for (int i = t; i < node_blocks; i += energy_threads) nodes += all.nodes[list[i]];
  of_particles[t] = particles;
  of_nodes[t] = nodes;
  add_up(of_particles);
  add_up(of_nodes);
  if (t == 0) all.steps[control->taken] = {control->dt, of_particles[0], of_nodes[0]};
}
