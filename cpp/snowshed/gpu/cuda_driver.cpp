#include "snowshed/gpu/cuda_driver.hpp"

#include <cstdlib>

#include "snowshed/core/errors.hpp"
#include "snowshed/gpu/shared_library.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

std::string driver_name() {
  const char* chosen = std::getenv("SNOWSHED_CUDA");
  return chosen && *chosen ? chosen : "libcuda.so.1";
}

SharedLibrary open_driver(const std::string& name) try {
  return SharedLibrary(name);
} catch (const Unavailable& error) {
  throw Unavailable("no NVIDIA driver: " + std::string(error.what()) +
                    "; install the driver of the card, which the command nvidia-smi then shows");
}

}  // namespace

CudaDriver::CudaDriver() : CudaDriver(driver_name()) {}

CudaDriver::CudaDriver(const std::string& library) {
  find_functions(open_driver(library));
  start();
}

/// Functions that have changed since their first version carry the number of the present one.
void CudaDriver::find_functions(const SharedLibrary& library) {
  library.find(Init, "cuInit");
  library.find(DriverGetVersion, "cuDriverGetVersion");
  library.find(GetErrorName, "cuGetErrorName");
  library.find(GetErrorString, "cuGetErrorString");
  library.find(DeviceGetCount, "cuDeviceGetCount");
  library.find(DeviceGet, "cuDeviceGet");
  library.find(DeviceGetName, "cuDeviceGetName");
  library.find(DeviceGetAttribute, "cuDeviceGetAttribute");
  library.find(DeviceGetPCIBusId, "cuDeviceGetPCIBusId");
  library.find(DevicePrimaryCtxRetain, "cuDevicePrimaryCtxRetain");
  library.find(DevicePrimaryCtxRelease, "cuDevicePrimaryCtxRelease_v2");
  library.find(CtxPushCurrent, "cuCtxPushCurrent_v2");
  library.find(CtxPopCurrent, "cuCtxPopCurrent_v2");
  library.find(MemGetInfo, "cuMemGetInfo_v2");
  library.find(MemAlloc, "cuMemAlloc_v2");
  library.find(MemFree, "cuMemFree_v2");
  library.find(MemcpyHtoDAsync, "cuMemcpyHtoDAsync_v2");
  library.find(MemcpyDtoHAsync, "cuMemcpyDtoHAsync_v2");
  library.find(MemsetD8Async, "cuMemsetD8Async");
  library.find(StreamCreate, "cuStreamCreate");
  library.find(StreamSynchronize, "cuStreamSynchronize");
  library.find(StreamDestroy, "cuStreamDestroy_v2");
  library.find(ModuleLoadData, "cuModuleLoadData");
  library.find(ModuleUnload, "cuModuleUnload");
  library.find(ModuleGetFunction, "cuModuleGetFunction");
  library.find(FuncSetAttribute, "cuFuncSetAttribute");
  library.find(LaunchKernel, "cuLaunchKernel");
}

void CudaDriver::start() {
  cuda::Result result = Init(0);
  if (result == cuda::success) result = DeviceGetCount(&cards_);
  if (result == cuda::no_device || (result == cuda::success && cards_ == 0))
    throw Unavailable(
        "no NVIDIA card: the driver is installed but finds none; the command nvidia-smi lists the "
        "cards, and the environment variable CUDA_VISIBLE_DEVICES may hide them");
  if (result == cuda::success) result = DriverGetVersion(&cuda_version_);
  if (result != cuda::success)
    throw Unavailable("the NVIDIA driver does not start: " + describe(result) +
                      "; the command nvidia-smi shows whether driver and card work");
}

std::string CudaDriver::cuda_version() const {
  return std::to_string(cuda_major()) + "." + std::to_string(cuda_version_ % 1000 / 10);
}

void CudaDriver::check(cuda::Result result, const std::string& action) const {
  if (result != cuda::success)
    throw SimulationError("graphics card: " + action + " failed: " + describe(result));
}

std::string CudaDriver::describe(cuda::Result result) const {
  const char *name = nullptr, *description = nullptr;
  if (GetErrorName(result, &name) != cuda::success || !name)
    return "error " + std::to_string(result);
  if (GetErrorString(result, &description) != cuda::success || !description) return name;
  return std::string(name) + " (" + description + ")";
}

}  // namespace snowshed::gpu
