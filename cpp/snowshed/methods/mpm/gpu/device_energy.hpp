// The balance of energy in the memory of a device.
#pragma once

#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceEnergy {
 public:
  using HostState = State<float, 3>;

  /// Without the balance it stays empty, and launches nothing.
  DeviceEnergy(snowshed::gpu::Device& device, bool is_kept);

  bool is_kept() const { return is_kept_; }
  /// Follows a change of the layout; `scatter` must follow.
  void connect(const HostState&);
  /// Adds up the particles of some blocks, whose first particles are given; in a step if `control`
  /// is given.
  void add_particles(const DeviceArray<std::int32_t>& blocks,
                     const DeviceArray<std::int32_t>& first, const Control* control) const;
  /// Queues the record of a step, in which these blocks of nodes took part.
  void record(const DeviceArray<std::int32_t>& node_blocks, const Control*) const;
  /// Gives the host's balance the `count` steps since it looked.
  void replay(HostState&, std::int64_t count) const;
  /// Returns the kinetic energy of some blocks of particles after the last step, J.
  double kinetic(const std::vector<std::int32_t>& blocks) const;

  EnergyArrays view() const;
  std::size_t bytes() const;

 private:
  snowshed::gpu::Device& device_;
  bool is_kept_;
  DeviceArray<ParticleEnergies> particles_, blocks_;
  DeviceArray<NodeEnergies> nodes_;
  DeviceArray<StepEnergies> steps_;
};

}  // namespace snowshed::methods::mpm::gpu
