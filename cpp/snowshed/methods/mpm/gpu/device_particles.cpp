#include "snowshed/methods/mpm/gpu/device_particles.hpp"

#include <numeric>

namespace snowshed::methods::mpm::gpu {

void DeviceParticles::upload(const HostParticles& particles) {
  size_ = particles.size();
  has_affine_ = particles.has_affine;
  has_plastic_ = particles.has_plastic;
  has_material_id_ = particles.has_material_id;
  std::size_t next = 0;
  particles.for_each_array([&](const char*, const auto& array) {
    if (next == arrays_.size())
      arrays_.push_back({sizeof(array[0]), DeviceArray<std::uint8_t>(device_)});
    arrays_[next++].values.upload(reinterpret_cast<const std::uint8_t*>(array.data()),
                                  size_ * sizeof(array[0]));
  });
}

void DeviceParticles::download(HostParticles& particles) const {
  std::size_t next = 0;
  particles.resize(size_);
  particles.for_each_array([&](const char*, auto& array) {
    arrays_[next++].values.download(reinterpret_cast<std::uint8_t*>(array.data()));
  });
}

std::size_t DeviceParticles::bytes() const {
  return std::accumulate(
      arrays_.begin(), arrays_.end(), spare_.bytes(),
      [](std::size_t sum, const Array& array) { return sum + array.values.bytes(); });
}

/// The arrays are in the order of Particles::for_each_array.
ParticleArrays DeviceParticles::view() const {
  ParticleArrays p{};
  std::size_t next = 0;
  for (float*& cell : p.cell) cell = static_cast<float*>(array(next));
  for (float*& velocity : p.velocity) velocity = static_cast<float*>(array(next));
  if (has_affine_)
    for (float*& affine : p.affine) affine = static_cast<float*>(array(next));
  for (float*& strain : p.be_minus_identity) strain = static_cast<float*>(array(next));
  if (has_plastic_) p.plastic = static_cast<float*>(array(next));
  p.mass = static_cast<const float*>(array(next));
  next += 2;  // id and event
  if (has_material_id_) p.material_id = static_cast<const std::uint8_t*>(array(next));
  return p;
}

/// Gathers the values of an array in `spare_`: value i is that of particle order[i].
void DeviceParticles::launch_permute(const Array& array, const DeviceArray<std::int32_t>& order,
                                     std::size_t count) {
  constexpr unsigned threads = 256;
  const snowshed::gpu::LaunchShape shape{(unsigned(count) + threads - 1) / threads, threads};
  const char* kernel = array.value_bytes == 4   ? "permute4"
                       : array.value_bytes == 2 ? "permute2"
                                                : "permute1";
  spare_.resize(count * array.value_bytes);
  launch(device_, kernel, shape, array.values.data(), spare_.data(), order.data(),
         std::int32_t(count));
}

void DeviceParticles::permute(const DeviceArray<std::int32_t>& order) {
  for (Array& array : arrays_) {
    launch_permute(array, order, size_);
    array.values.swap(spare_);
  }
}

void DeviceParticles::download(HostParticles& particles, const std::vector<std::int32_t>& some) {
  some_.upload(some);
  std::size_t next = 0;
  particles.for_each_array([&](const char*, auto& array) {
    launch_permute(arrays_[next++], some_, some.size());
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    std::vector<Value> values(some.size());
    spare_.download(reinterpret_cast<std::uint8_t*>(values.data()));
    for (std::size_t i = 0; i < some.size(); ++i) array[std::size_t(some[i])] = values[i];
  });
}

}  // namespace snowshed::methods::mpm::gpu
