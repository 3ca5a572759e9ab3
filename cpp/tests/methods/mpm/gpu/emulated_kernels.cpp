#include "methods/mpm/gpu/emulated_kernels.hpp"

#include "gpu/cuda_on_host.hpp"
//
#include "snowshed/methods/mpm/gpu/kernels.cuh"

namespace snowshed::methods::mpm {

const snowshed::gpu::EmulatedDevice::Kernels& emulated_kernels() {
  using snowshed::gpu::unpacked;
  static const snowshed::gpu::EmulatedDevice::Kernels kernels{
      {"next_step", unpacked(next_step)},
      {"judge_step", unpacked(judge_step)},
      {"node_step", unpacked(node_step)},
      {"overlap_step", unpacked(overlap_step)},
      {"find_event_contacts", unpacked(find_event_contacts)},
      {"find_radii", unpacked(find_radii)},
      {"record_forces", unpacked(record_forces)},
      {"find_cell_ranges", unpacked(find_cell_ranges)},
      {"find_friction_shares", unpacked(find_friction_shares)},
      {"probe", unpacked(probe)},
      {"particle_step", unpacked(particle_step)},
      {"particle_step_several", unpacked(particle_step_several)},
      {"particle_step_affine", unpacked(particle_step_affine)},
      {"particle_step_several_affine", unpacked(particle_step_several_affine)},
      {"stray_step", unpacked(stray_step)},
      {"stray_step_several", unpacked(stray_step_several)},
      {"stray_step_affine", unpacked(stray_step_affine)},
      {"stray_step_several_affine", unpacked(stray_step_several_affine)},
      {"scatter", unpacked(scatter)},
      {"scatter_several", unpacked(scatter_several)},
      {"scatter_affine", unpacked(scatter_affine)},
      {"scatter_several_affine", unpacked(scatter_several_affine)},
      {"scatter_strays", unpacked(scatter_strays)},
      {"scatter_strays_several", unpacked(scatter_strays_several)},
      {"scatter_strays_affine", unpacked(scatter_strays_affine)},
      {"scatter_strays_several_affine", unpacked(scatter_strays_several_affine)},
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
