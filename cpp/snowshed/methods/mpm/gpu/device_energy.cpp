#include "snowshed/methods/mpm/gpu/device_energy.hpp"

#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

constexpr unsigned threads = 128;

}  // namespace

DeviceEnergy::DeviceEnergy(snowshed::gpu::Device& device, bool is_kept)
    : device_(device),
      is_kept_(is_kept),
      particles_(device),
      blocks_(device),
      nodes_(device),
      steps_(device) {
  if (is_kept_) steps_.resize(std::size_t(steps_between_sorts));
}

void DeviceEnergy::connect(const HostState& state) {
  if (!is_kept_) return;
  particles_.resize(state.particles.size());
  blocks_.resize(state.layout.particle_blocks.size());
  nodes_.resize(state.layout.grid_blocks.size());
}

void DeviceEnergy::add_particles(const DeviceArray<std::int32_t>& blocks,
                                 const DeviceArray<std::int32_t>& first,
                                 const Control* control) const {
  if (!is_kept_) return;
  launch(device_, "add_particle_energies", {unsigned(blocks.size()), threads},
         static_cast<const std::int32_t*>(blocks.data()),
         static_cast<const std::int32_t*>(first.data()), view(), control);
}

void DeviceEnergy::record(const DeviceArray<std::int32_t>& node_blocks,
                          const Control* control) const {
  if (!is_kept_) return;
  launch(device_, "record_energies", {1, threads},
         static_cast<const std::int32_t*>(node_blocks.data()), std::int32_t(node_blocks.size()),
         std::int32_t(blocks_.size()), view(), control);
}

void DeviceEnergy::replay(HostState& state, std::int64_t count) const {
  if (!is_kept_ || count == 0) return;
  const std::vector<StepEnergies> steps = steps_.download();
  for (std::size_t k = 0; k < std::size_t(count); ++k) add_step(state.totals, steps[k]);
}

double DeviceEnergy::kinetic(const std::vector<std::int32_t>& blocks) const {
  if (!is_kept_ || blocks.empty()) return 0;
  const std::vector<ParticleEnergies> all = blocks_.download();
  double sum = 0;
  for (const std::int32_t b : blocks) sum += all[std::size_t(b)].kinetic;
  return sum;
}

EnergyArrays DeviceEnergy::view() const {
  if (!is_kept_) return {};
  return {particles_.data(), blocks_.data(), nodes_.data(), steps_.data()};
}

std::size_t DeviceEnergy::bytes() const {
  return particles_.bytes() + blocks_.bytes() + nodes_.bytes() + steps_.bytes();
}

}  // namespace snowshed::methods::mpm::gpu
