// The particles in the memory of a device.
#pragma once

#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/particles.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceParticles {
 public:
  using HostParticles = Particles<float, 3>;

  explicit DeviceParticles(snowshed::gpu::Device& device)
      : device_(device), spare_(device), some_(device) {}

  void upload(const HostParticles&);
  /// Overwrites the values of as many particles in the same order.
  void download(HostParticles&) const;

  /// Overwrites the values of some particles, and leaves those of the others.
  void download(HostParticles&, const std::vector<std::int32_t>& some);

  std::size_t size() const { return size_; }
  std::size_t bytes() const;
  ParticleArrays view() const;

  /// Rearranges: the new particle i is the old particle order[i].
  void permute(const DeviceArray<std::int32_t>& order);

 private:
  struct Array {
    std::size_t value_bytes;
    DeviceArray<std::uint8_t> values;
  };
  void launch_permute(const Array&, const DeviceArray<std::int32_t>& order, std::size_t count);
  void* array(std::size_t& next) const { return arrays_[next++].values.data(); }

  snowshed::gpu::Device& device_;
  std::vector<Array> arrays_;  // in the order of Particles::for_each_array
  DeviceArray<std::uint8_t> spare_;
  DeviceArray<std::int32_t> some_;
  std::size_t size_ = 0;
  bool has_affine_ = false, has_plastic_ = false, has_material_id_ = false;
};

}  // namespace snowshed::methods::mpm::gpu
