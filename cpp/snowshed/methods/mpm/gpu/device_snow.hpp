// The snow and the grid in the memory of a device, and the kernels on them. The layout of the
// blocks, the contacts of new blocks and the decision which blocks sleep are the host's.
#pragma once

#include "snowshed/methods/mpm/gpu/device_average.hpp"
#include "snowshed/methods/mpm/gpu/device_energy.hpp"
#include "snowshed/methods/mpm/gpu/device_events.hpp"
#include "snowshed/methods/mpm/gpu/device_forces.hpp"
#include "snowshed/methods/mpm/gpu/device_particles.hpp"
#include "snowshed/methods/mpm/model.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceSnow {
 public:
  using HostState = State<float, 3>;

  DeviceSnow(snowshed::gpu::Device& device, const Model<float, 3>& model);

  /// Uploads all of a state. `scatter` must follow before a step.
  void upload(HostState&);
  /// Brings the particles and the contacts of the host up to date.
  void download(HostState&) const;
  /// Brings the particles of some blocks up to date.
  void download_blocks(HostState&, const std::vector<std::int32_t>& blocks);
  /// Brings only the contacts up to date, with their forces.
  void download_contacts(HostState&) const;
  /// Uploads contacts that the host has changed.
  void upload_contacts(HostState&);
  /// Uploads which blocks sleep.
  void upload_sleep(const HostState&);

  /// Sorts the particles by blocks, which changes the layout, the contacts and the sleep of the
  /// host's state, too. `scatter` must follow.
  void sort(HostState&);
  /// Computes the sums of the grid from the particles, of which control.speed_squared is the
  /// largest square of a speed.
  void scatter(Control& control);

  /// Finds the contacts between events after a sort and `scatter`.
  void find_event_contacts();

  /// Takes up to `rounds` steps, until control.until or control.steps_left or an event for the
  /// host. Waits for their end.
  void run(Control&, int rounds);

  /// Stops the particles of some blocks.
  void stop(const std::vector<std::int32_t>& blocks);
  /// Returns the motion of the particle blocks that are awake or beside awake snow; the other
  /// entries are undefined.
  std::vector<BlockMotion> motions(const Sleep<3>&);

  /// Gives the host's record of forces the `count` steps of the last run.
  void replay_forces(HostState& state, std::int64_t count) const { forces_.replay(state, count); }
  /// Gives the host's balance of energy these steps.
  void replay_energies(HostState& state, std::int64_t count) const { energy_.replay(state, count); }
  /// Returns the kinetic energy of some blocks of particles after the last step, J; zero without
  /// the balance of energy.
  double kinetic_energy(const std::vector<std::int32_t>& blocks) const {
    return energy_.kinetic(blocks);
  }
  /// Returns the ranges of the cells of sleeping blocks; the other entries are undefined.
  std::vector<CellRange> cell_ranges_asleep() { return cell_ranges(asleep_blocks_); }

  /// Memory on the device.
  std::size_t bytes() const;

 private:
  void upload_layout(HostState&);
  void find_units(const HostState&);
  std::vector<CellRange> cell_ranges(const DeviceArray<std::int32_t>& blocks);
  void find_spin(Control& control);
  void launch_round();
  void launch_average(const DeviceArray<std::int32_t>& list, bool asleep);
  void launch_particles(const char* kernel, const DeviceArray<std::int32_t>& list,
                        unsigned long long* integers);
  void launch_strays(const char* kernel, unsigned long long* integers);
  std::string named(const char* kernel) const;
  ParticleLaunch launch_of(const DeviceArray<std::int32_t>& list,
                           unsigned long long* integers) const;
  GridArrays grid() const;
  ContactArrays contacts() const;

  snowshed::gpu::Device& device_;
  const Model<float, 3>& model_;
  DeviceParticles particles_;
  DeviceForces forces_;
  DeviceAverage average_;
  DeviceEvents events_;
  DeviceEnergy energy_;
  DeviceArray<std::int32_t> first_, around_, order_, strays_;
  DeviceArray<float> fastest_;
  DeviceArray<std::int32_t> awake_, asleep_blocks_, active_, idle_, listed_;
  DeviceArray<unsigned long long> integers_, asleep_;
  DeviceArray<Quad> carried_, force_, velocity_;
  DeviceArray<Pair> change_;
  DeviceArray<float> ranges_, friction_, friction_shares_;
  DeviceArray<std::int32_t> first_contact_, conditions_;
  DeviceArray<Contact<float>> contacts_;
  DeviceArray<MaterialConstants<float>> snows_;
  DeviceArray<BlockMotion> motions_;
  DeviceArray<CellRange> cell_ranges_;
  DeviceArray<Control> control_;
  Constants constants_{};
  std::int32_t blocks_ = 0;  // number of particle blocks
};

}  // namespace snowshed::methods::mpm::gpu
