// A graphics card of NVIDIA as a device.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>

#include "snowshed/gpu/cuda_driver.hpp"
#include "snowshed/gpu/device.hpp"
#include "snowshed/io/folder_lock.hpp"

namespace snowshed::gpu {

/// The card uses the context that all libraries of the process share, and a stream of its own. An
/// error of a kernel shows at the next call that waits; after it the card can do no more in this
/// process.
class CudaDevice final : public Device {
 public:
  /// Opens a card and loads the machine code of its kernels. The claim on the card ends with the
  /// device. Throws SimulationError.
  CudaDevice(std::shared_ptr<const CudaDriver>, cuda::DeviceNumber, std::string name,
             const std::string& machine_code,
             std::shared_ptr<const io::FolderLock> claim = nullptr);
  ~CudaDevice() override;
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  std::string name() const override { return name_; }
  std::size_t free_bytes() const override;

  Address allocate(std::size_t bytes) override;
  void free(Address address) noexcept override;

  void upload(Address to, const void* from, std::size_t bytes) override;
  void download(void* to, Address from, std::size_t bytes) override;
  void clear(Address address, std::size_t bytes) override;

  void launch(const char* kernel, LaunchShape shape, void** arguments) override;

 private:
  class Context;
  class Current;
  struct Kernel {
    cuda::Function function;
    std::size_t shared_bytes;  // may be used
  };

  Kernel& kernel(const char* name);
  void allow_shared_bytes(Kernel&, const char* name, std::size_t bytes);

  std::shared_ptr<const CudaDriver> driver_;
  std::string name_;
  std::shared_ptr<const io::FolderLock> claim_;
  std::unique_ptr<Context> context_;
  std::unordered_map<std::string, Kernel> kernels_;
};

}  // namespace snowshed::gpu
