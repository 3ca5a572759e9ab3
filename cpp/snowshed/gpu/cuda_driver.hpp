// The functions of NVIDIA's driver that this program calls. The driver's library is opened while
// the program runs, and its types are declared here, so that nothing of CUDA is needed to build.
#pragma once

#include <cstddef>
#include <string>

#include "snowshed/gpu/device.hpp"

namespace snowshed::gpu {

class SharedLibrary;

/// The driver's types. Handles are pointers whose targets only the driver knows.
namespace cuda {

using Result = int;  // 0: success
using DeviceNumber = int;
using Context = struct ContextTag*;
using Module = struct ModuleTag*;
using Function = struct FunctionTag*;
using Stream = struct StreamTag*;

inline constexpr Result success = 0, out_of_memory = 2, no_device = 100;

// Numbers of the driver's enumerations.
inline constexpr int compute_capability_major = 75, compute_capability_minor = 76;
inline constexpr int max_shared_bytes = 8;          // attribute of a function: more than 48 KB
inline constexpr unsigned non_blocking_stream = 1;  // does not wait for the default stream

}  // namespace cuda

/// The driver's functions, each named as the driver names it without "cu". They are described in
/// the CUDA Driver API, under the name with "cu".
class CudaDriver {
 public:
  /// Opens the driver: the library that the environment variable SNOWSHED_CUDA names, otherwise
  /// libcuda.so.1. Throws Unavailable if there is no driver, or if it finds no card.
  CudaDriver();
  /// Opens the driver of this name.
  explicit CudaDriver(const std::string& library);

  /// The newest version of CUDA that the driver supports, such as 13 for 13.0.
  int cuda_major() const { return cuda_version_ / 1000; }
  /// The same with its minor version, such as "13.0".
  std::string cuda_version() const;

  /// The number of cards that this process may use, at least 1.
  int cards() const { return cards_; }

  /// Throws SimulationError unless the result is success. It says what failed and quotes the
  /// driver.
  void check(cuda::Result result, const std::string& action) const;
  /// The driver's name and description of an error.
  std::string describe(cuda::Result result) const;

  cuda::Result (*Init)(unsigned flags);
  cuda::Result (*DriverGetVersion)(int* version);
  cuda::Result (*GetErrorName)(cuda::Result, const char** name);
  cuda::Result (*GetErrorString)(cuda::Result, const char** description);
  cuda::Result (*DeviceGetCount)(int* count);
  cuda::Result (*DeviceGet)(cuda::DeviceNumber*, int ordinal);
  cuda::Result (*DeviceGetName)(char* name, int length, cuda::DeviceNumber);
  cuda::Result (*DeviceGetAttribute)(int* value, int attribute, cuda::DeviceNumber);
  cuda::Result (*DeviceGetPCIBusId)(char* id, int length, cuda::DeviceNumber);
  cuda::Result (*DevicePrimaryCtxRetain)(cuda::Context*, cuda::DeviceNumber);
  cuda::Result (*DevicePrimaryCtxRelease)(cuda::DeviceNumber);
  cuda::Result (*CtxPushCurrent)(cuda::Context);
  cuda::Result (*CtxPopCurrent)(cuda::Context*);
  cuda::Result (*MemGetInfo)(std::size_t* free, std::size_t* total);
  cuda::Result (*MemAlloc)(Address*, std::size_t bytes);
  cuda::Result (*MemFree)(Address);
  cuda::Result (*MemcpyHtoDAsync)(Address to, const void* from, std::size_t bytes, cuda::Stream);
  cuda::Result (*MemcpyDtoHAsync)(void* to, Address from, std::size_t bytes, cuda::Stream);
  cuda::Result (*MemsetD8Async)(Address, unsigned char value, std::size_t bytes, cuda::Stream);
  cuda::Result (*StreamCreate)(cuda::Stream*, unsigned flags);
  cuda::Result (*StreamSynchronize)(cuda::Stream);
  cuda::Result (*StreamDestroy)(cuda::Stream);
  cuda::Result (*ModuleLoadData)(cuda::Module*, const void* image);
  cuda::Result (*ModuleUnload)(cuda::Module);
  cuda::Result (*ModuleGetFunction)(cuda::Function*, cuda::Module, const char* name);
  cuda::Result (*FuncSetAttribute)(cuda::Function, int attribute, int value);
  cuda::Result (*LaunchKernel)(cuda::Function, unsigned blocks_x, unsigned blocks_y,
                               unsigned blocks_z, unsigned threads_x, unsigned threads_y,
                               unsigned threads_z, unsigned shared_bytes, cuda::Stream,
                               void** arguments, void** extra);

 private:
  void find_functions(const SharedLibrary&);
  void start();

  int cuda_version_ = 0, cards_ = 0;
};

}  // namespace snowshed::gpu
