// The record of forces in the memory of a device.
#pragma once

#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceForces {
 public:
  using HostState = State<float, 3>;

  /// The record of a run with so many obstacles; without any it stays empty.
  DeviceForces(snowshed::gpu::Device& device, std::size_t obstacles);

  /// Uploads the forces at the contacts.
  void upload(HostState&);
  /// Brings the forces at the host's contacts up to date.
  void download(HostState&) const;

  /// Gives the host's record the `count` steps since it looked.
  void replay(HostState&, std::int64_t count) const;

  ForceArrays view() const;
  unsigned obstacles() const { return unsigned(obstacles_); }
  std::size_t bytes() const { return contacts_.bytes() + blocks_.bytes() + steps_.bytes(); }

 private:
  std::size_t obstacles_;
  DeviceArray<ContactForce<float>> contacts_;
  DeviceArray<float> blocks_;
  DeviceArray<double> steps_;
};

}  // namespace snowshed::methods::mpm::gpu
