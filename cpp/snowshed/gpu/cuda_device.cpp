#include "snowshed/gpu/cuda_device.hpp"

#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"

namespace snowshed::gpu {
namespace {

constexpr std::size_t shared_bytes_of_all_cards = 48 * 1024;

std::string megabytes(std::size_t bytes) { return show_rounded(double(bytes) / 1e6) + " MB"; }

}  // namespace

/// The needs of a call: the context, a stream and the loaded kernels. Each is released even if the
/// next one fails.
class CudaDevice::Context {
 public:
  Context(const CudaDriver& driver, cuda::DeviceNumber number, const std::string& machine_code)
      : driver_(driver), number_(number) {
    driver.check(driver.DevicePrimaryCtxRetain(&context_, number), "opening it");
    try {
      prepare(machine_code);
    } catch (...) {
      release();
      throw;
    }
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { release(); }

  cuda::Context handle() const { return context_; }
  cuda::Stream stream() const { return stream_; }
  cuda::Module module() const { return module_; }

 private:
  void prepare(const std::string& machine_code) {
    driver_.check(driver_.CtxPushCurrent(context_), "choosing it");
    cuda::Result result = driver_.StreamCreate(&stream_, cuda::non_blocking_stream);
    if (result == cuda::success) result = driver_.ModuleLoadData(&module_, machine_code.data());
    cuda::Context popped;
    driver_.CtxPopCurrent(&popped);
    driver_.check(result, "loading the kernels");
  }
  /// Nothing can be done about errors here: a card that failed has no use for the calls.
  void release() noexcept {
    driver_.CtxPushCurrent(context_);
    if (module_) driver_.ModuleUnload(module_);
    if (stream_) driver_.StreamDestroy(stream_);
    cuda::Context popped;
    driver_.CtxPopCurrent(&popped);
    driver_.DevicePrimaryCtxRelease(number_);
  }

  const CudaDriver& driver_;
  cuda::DeviceNumber number_;
  cuda::Context context_ = nullptr;
  cuda::Stream stream_ = nullptr;
  cuda::Module module_ = nullptr;
};

/// Makes the card's context that of this thread for one call, because calls may come from any.
class CudaDevice::Current {
 public:
  explicit Current(const CudaDevice& device) : driver_(*device.driver_) {
    driver_.check(driver_.CtxPushCurrent(device.context_->handle()), "choosing it");
  }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;
  ~Current() {
    cuda::Context popped;
    driver_.CtxPopCurrent(&popped);
  }

 private:
  const CudaDriver& driver_;
};

CudaDevice::CudaDevice(std::shared_ptr<const CudaDriver> driver, cuda::DeviceNumber number,
                       std::string name, const std::string& machine_code,
                       std::shared_ptr<const io::FolderLock> claim)
    : driver_(std::move(driver)),
      name_(std::move(name)),
      claim_(std::move(claim)),
      context_(std::make_unique<Context>(*driver_, number, machine_code)) {}

CudaDevice::~CudaDevice() = default;

std::size_t CudaDevice::free_bytes() const {
  const Current current(*this);
  std::size_t free = 0, total = 0;
  driver_->check(driver_->MemGetInfo(&free, &total), "asking for its free memory");
  return free;
}

Address CudaDevice::allocate(std::size_t bytes) {
  if (bytes == 0) return 0;
  const Current current(*this);
  Address address = 0;
  const cuda::Result result = driver_->MemAlloc(&address, bytes);
  if (result == cuda::out_of_memory)
    throw SimulationError("the memory of the " + name_ + " does not suffice: " + megabytes(bytes) +
                          " were asked for, " + megabytes(free_bytes()) +
                          " are free; give fewer particles or a larger dx");
  driver_->check(result, "taking " + megabytes(bytes) + " of its memory");
  return address;
}

void CudaDevice::free(Address address) noexcept {
  if (!address || driver_->CtxPushCurrent(context_->handle()) != cuda::success) return;
  driver_->MemFree(address);
  cuda::Context popped;
  driver_->CtxPopCurrent(&popped);
}

void CudaDevice::upload(Address to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  const Current current(*this);
  driver_->check(driver_->MemcpyHtoDAsync(to, from, bytes, context_->stream()), "copying to it");
}

void CudaDevice::download(void* to, Address from, std::size_t bytes) {
  const Current current(*this);
  if (bytes > 0)
    driver_->check(driver_->MemcpyDtoHAsync(to, from, bytes, context_->stream()),
                   "copying from it");
  driver_->check(driver_->StreamSynchronize(context_->stream()), "a kernel or a copy");
}

void CudaDevice::clear(Address address, std::size_t bytes) {
  if (bytes == 0) return;
  const Current current(*this);
  driver_->check(driver_->MemsetD8Async(address, 0, bytes, context_->stream()), "clearing memory");
}

void CudaDevice::launch(const char* name, LaunchShape shape, void** arguments) {
  if (shape.blocks == 0) return;  // the driver does not take this for nothing to do
  const Current current(*this);
  Kernel& launched = kernel(name);
  allow_shared_bytes(launched, name, shape.shared_bytes);
  driver_->check(
      driver_->LaunchKernel(launched.function, shape.blocks, 1, 1, shape.threads, 1, 1,
                            unsigned(shape.shared_bytes), context_->stream(), arguments, nullptr),
      "launching the kernel " + std::string(name));
}

CudaDevice::Kernel& CudaDevice::kernel(const char* name) {
  const auto known = kernels_.find(name);
  if (known != kernels_.end()) return known->second;
  cuda::Function function = nullptr;
  driver_->check(driver_->ModuleGetFunction(&function, context_->module(), name),
                 "looking up the kernel " + std::string(name));
  return kernels_.emplace(name, Kernel{function, shared_bytes_of_all_cards}).first->second;
}

/// More than a certain amount must be asked for, once.
void CudaDevice::allow_shared_bytes(Kernel& kernel, const char* name, std::size_t bytes) {
  if (bytes <= kernel.shared_bytes) return;
  driver_->check(
      driver_->FuncSetAttribute(kernel.function, cuda::max_shared_bytes, int(bytes)),
      "giving the kernel " + std::string(name) + " " + std::to_string(bytes) + " shared bytes");
  kernel.shared_bytes = bytes;
}

}  // namespace snowshed::gpu
