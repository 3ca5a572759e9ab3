// A device that runs kernels: a graphics card, or in tests a processor that plays one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace snowshed::gpu {

/// The place of bytes in the memory of a device. 0 is no place.
using Address = std::uint64_t;

/// The shape of a launch: blocks of threads, and the bytes that the threads of a block share.
struct LaunchShape {
  unsigned blocks, threads;
  std::size_t shared_bytes = 0;
};

/// Memory and kernels of a device. Calls take effect in their order; `launch` and `clear` return
/// before they are done. A failed call throws an error that says what the device answered.
class Device {
 public:
  virtual ~Device() = default;

  virtual std::string name() const = 0;
  virtual std::size_t free_bytes() const = 0;

  /// Throws if the memory is not there, and says how much was asked for and how much is free.
  virtual Address allocate(std::size_t bytes) = 0;
  virtual void free(Address address) noexcept = 0;

  virtual void upload(Address to, const void* from, std::size_t bytes) = 0;
  /// Waits for everything that was launched before.
  virtual void download(void* to, Address from, std::size_t bytes) = 0;
  virtual void clear(Address address, std::size_t bytes) = 0;

  /// Launches a kernel by its name. `arguments` has a pointer to each argument, in their order.
  virtual void launch(const char* kernel, LaunchShape shape, void** arguments) = 0;
};

}  // namespace snowshed::gpu
