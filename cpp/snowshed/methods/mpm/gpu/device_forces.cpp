#include "snowshed/methods/mpm/gpu/device_forces.hpp"

#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm::gpu {

DeviceForces::DeviceForces(snowshed::gpu::Device& device, std::size_t obstacles)
    : obstacles_(obstacles), contacts_(device), blocks_(device), steps_(device) {
  if (obstacles_ > 0)
    steps_.resize(std::size_t(steps_between_sorts) * std::size_t(recorded_values(int(obstacles_))));
}

void DeviceForces::upload(HostState& state) {
  if (obstacles_ == 0) return;
  contacts_.upload(state.contacts.all_forces());
  blocks_.resize(state.layout.grid_blocks.size() * 3);
}

void DeviceForces::download(HostState& state) const {
  if (obstacles_ > 0) contacts_.download(state.contacts.all_forces().data());
}

void DeviceForces::replay(HostState& state, std::int64_t count) const {
  const std::vector<double> steps = steps_.download();
  ObstacleForces& record = state.forces->forces;
  const std::size_t values = std::size_t(recorded_values(int(obstacles_)));
  for (std::size_t k = 0; k < std::size_t(count); ++k) {
    const double* step = steps.data() + k * values;
    for (std::size_t o = 0; o < obstacles_; ++o)
      record.add_step(record.name_of(int(o)), -Vec3(Vec3::Map(step + 2 + o * 3)));
    state.end_force_step(step[0], step[1]);
  }
}

ForceArrays DeviceForces::view() const {
  if (obstacles_ == 0) return {nullptr, nullptr, nullptr};
  return {contacts_.data(), blocks_.data(), steps_.data()};
}

}  // namespace snowshed::methods::mpm::gpu
