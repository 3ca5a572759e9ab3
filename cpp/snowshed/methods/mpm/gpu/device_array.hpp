// An array in the memory of a device.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "snowshed/gpu/device.hpp"

namespace snowshed::methods::mpm::gpu {

template <class Value>
class DeviceArray {
 public:
  explicit DeviceArray(snowshed::gpu::Device& device) : device_(&device) {}
  DeviceArray(DeviceArray&& other) noexcept
      : device_(other.device_),
        address_(std::exchange(other.address_, 0)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  DeviceArray& operator=(DeviceArray&&) = delete;
  DeviceArray(const DeviceArray&) = delete;
  ~DeviceArray() { release(); }

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(Value); }
  Value* data() const { return reinterpret_cast<Value*>(address_); }

  /// Gives the array another size; its values are lost.
  void resize(std::size_t size) {
    if (size > capacity_) {
      release();
      const std::size_t room = size + size / 8;  // layouts grow step by step
      address_ = device_->allocate(room * sizeof(Value));
      capacity_ = room;
    }
    size_ = size;
  }
  void upload(const Value* values, std::size_t count) {
    resize(count);
    if (count > 0) device_->upload(address_, values, count * sizeof(Value));
  }
  template <class Values>
  void upload(const Values& values) {
    upload(values.data(), values.size());
  }
  void download(Value* values) const {
    if (size_ > 0) device_->download(values, address_, size_ * sizeof(Value));
  }
  std::vector<Value> download() const {
    std::vector<Value> values(size_);
    download(values.data());
    return values;
  }
  /// Sets all bytes to zero.
  void clear() {
    if (size_ > 0) device_->clear(address_, size_ * sizeof(Value));
  }
  void swap(DeviceArray& other) noexcept {
    std::swap(address_, other.address_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  void release() noexcept {
    if (address_) device_->free(address_);
    address_ = 0;
    size_ = capacity_ = 0;
  }

  snowshed::gpu::Device* device_;
  snowshed::gpu::Address address_ = 0;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Launches a kernel with its arguments.
template <class... Arguments>
void launch(snowshed::gpu::Device& device, const char* kernel, snowshed::gpu::LaunchShape shape,
            Arguments... arguments) {
  if (shape.blocks == 0) return;
  void* addresses[] = {&arguments...};
  device.launch(kernel, shape, addresses);
}

}  // namespace snowshed::methods::mpm::gpu
