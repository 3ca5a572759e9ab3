// A device whose kernels run on the processor, to test them where there is no graphics card.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "snowshed/gpu/device.hpp"

namespace snowshed::gpu {

/// The order in which the threads of a block, and the blocks, take their turns. A kernel whose
/// result depends on it has a race.
enum class Turns { forwards, backwards };

class EmulatedDevice final : public Device {
 public:
  using Kernel = std::function<void(void** arguments)>;
  using Kernels = std::map<std::string, Kernel>;

  EmulatedDevice(const Kernels& kernels, Turns turns) : kernels_(kernels), turns_(turns) {}
  ~EmulatedDevice() override;

  std::string name() const override { return "a card played by the processor"; }
  std::size_t free_bytes() const override { return std::size_t(1) << 32; }
  Address allocate(std::size_t bytes) override;
  void free(Address address) noexcept override;
  void upload(Address to, const void* from, std::size_t bytes) override;
  void download(void* to, Address from, std::size_t bytes) override;
  void clear(Address address, std::size_t bytes) override;
  void launch(const char* kernel, LaunchShape shape, void** arguments) override;

  /// Launches of each kernel.
  const std::map<std::string, int>& launches() const { return launches_; }
  std::size_t bytes_in_use() const;

 private:
  void check(Address address, std::size_t bytes) const;

  const Kernels& kernels_;
  Turns turns_;
  std::map<Address, std::size_t> memory_;
  std::map<std::string, int> launches_;
};

template <class... Arguments, std::size_t... i>
EmulatedDevice::Kernel unpacked(void (*kernel)(Arguments...), std::index_sequence<i...>) {
  return [kernel](void** arguments) { kernel(*static_cast<Arguments*>(arguments[i])...); };
}

/// A kernel that takes its arguments from the addresses of a launch.
template <class... Arguments>
EmulatedDevice::Kernel unpacked(void (*kernel)(Arguments...)) {
  return unpacked(kernel, std::index_sequence_for<Arguments...>());
}

}  // namespace snowshed::gpu
