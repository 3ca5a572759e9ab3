#include "methods/mpm/gpu/emulated_kernels.hpp"

#include "gpu/cuda_on_host.hpp"
//
#include "snowshed/methods/mpm/gpu/energy_kernels.cuh"

namespace snowshed::methods::mpm {

const snowshed::gpu::EmulatedDevice::Kernels& emulated_kernels() {
  using snowshed::gpu::unpacked;
  static const snowshed::gpu::EmulatedDevice::Kernels kernels{
      {"next_step", unpacked(next_step)},
      {"judge_step", unpacked(judge_step)},
      {"node_step", unpacked(node_step)},
      {"node_step_energy", unpacked(node_step_energy)},
      {"overlap_step", unpacked(overlap_step)},
      {"overlap_step_energy", unpacked(overlap_step_energy)},
      {"find_event_contacts", unpacked(find_event_contacts)},
      {"find_radii", unpacked(find_radii)},
      {"record_forces", unpacked(record_forces)},
      {"add_particle_energies", unpacked(add_particle_energies)},
      {"record_energies", unpacked(record_energies)},
      {"find_cell_ranges", unpacked(find_cell_ranges)},
      {"find_friction_shares", unpacked(find_friction_shares)},
      {"probe", unpacked(probe)},
      {"particle_step", unpacked(particle_step)},
      {"particle_step_several", unpacked(particle_step_several)},
      {"particle_step_several_energy", unpacked(particle_step_several_energy)},
      {"particle_step_affine", unpacked(particle_step_affine)},
      {"particle_step_several_affine", unpacked(particle_step_several_affine)},
      {"particle_step_several_affine_energy", unpacked(particle_step_several_affine_energy)},
      {"stray_step", unpacked(stray_step)},
      {"stray_step_several", unpacked(stray_step_several)},
      {"stray_step_several_energy", unpacked(stray_step_several_energy)},
      {"stray_step_affine", unpacked(stray_step_affine)},
      {"stray_step_several_affine", unpacked(stray_step_several_affine)},
      {"stray_step_several_affine_energy", unpacked(stray_step_several_affine_energy)},
      {"scatter", unpacked(scatter)},
      {"scatter_several", unpacked(scatter_several)},
      {"scatter_several_energy", unpacked(scatter_several_energy)},
      {"scatter_affine", unpacked(scatter_affine)},
      {"scatter_several_affine", unpacked(scatter_several_affine)},
      {"scatter_several_affine_energy", unpacked(scatter_several_affine_energy)},
      {"scatter_strays", unpacked(scatter_strays)},
      {"scatter_strays_several", unpacked(scatter_strays_several)},
      {"scatter_strays_several_energy", unpacked(scatter_strays_several_energy)},
      {"scatter_strays_affine", unpacked(scatter_strays_affine)},
      {"scatter_strays_several_affine", unpacked(scatter_strays_several_affine)},
      {"scatter_strays_several_affine_energy", unpacked(scatter_strays_several_affine_energy)},
      {"scatter_average", unpacked(scatter_average)},
      {"average_nodes", unpacked(average_nodes)},
      {"find_spin", unpacked(find_spin)},
      {"count_moves", unpacked(count_moves)},
      {"find_order", unpacked(find_order)},
      {"permute4", unpacked(permute4)},
      {"permute2", unpacked(permute2)},
      {"permute1", unpacked(permute1)},
      {"measure_motion", unpacked(measure_motion)},
      {"stop_blocks", unpacked(stop_blocks)},
      {"clear_nodes", unpacked(clear_nodes)}};
  return kernels;
}

}  // namespace snowshed::methods::mpm
