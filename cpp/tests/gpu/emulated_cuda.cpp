// A driver whose card is played by the processor: it has the functions of libcuda that the program
// calls, and runs the kernels of the material point method in place of the machine code that it is
// given. With SNOWSHED_CUDA set to this library, a program runs any scene as it would on a card.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>

#include "methods/mpm/gpu/emulated_kernels.hpp"

namespace {

using snowshed::gpu::EmulatedDevice;

constexpr int out_of_memory = 2, not_found = 500, failed = 719;

EmulatedDevice& card() {
  static EmulatedDevice device(snowshed::methods::mpm::emulated_kernels(),
                               snowshed::gpu::Turns::forwards);
  return device;
}

/// Returns the result of a call.
template <class F>
int attempt(const F& f, int failure = failed) try {
  f();
  return 0;
} catch (const std::exception&) {
  return failure;
}

/// A handle that nobody looks into.
template <class Handle>
int give(Handle* handle) {
  *handle = &card();
  return 0;
}

}  // namespace

extern "C" {

int cuInit(unsigned) { return 0; }
int cuDriverGetVersion(int* version) {
  *version = 13000;
  return 0;
}
int cuGetErrorName(int, const char** name) {
  *name = "CUDA_ERROR_LAUNCH_FAILED";
  return 0;
}
int cuGetErrorString(int, const char** text) {
  *text = "the emulated card failed";
  return 0;
}
int cuDeviceGetCount(int* count) {
  *count = 1;
  return 0;
}
int cuDeviceGet(int* device, int ordinal) {
  *device = ordinal;
  return 0;
}
int cuDeviceGetName(char* name, int length, int) {
  std::strncpy(name, card().name().c_str(), std::size_t(length));
  return 0;
}
int cuDeviceGetPCIBusId(char* id, int length, int) {
  std::strncpy(id, "0000:00:00.0", std::size_t(length));
  return 0;
}
/// Compute capability 9.0.
int cuDeviceGetAttribute(int* value, int attribute, int) {
  *value = attribute == 75 ? 9 : 0;
  return 0;
}
int cuDevicePrimaryCtxRetain(void** context, int) { return give(context); }
int cuDevicePrimaryCtxRelease_v2(int) { return 0; }
int cuCtxPushCurrent_v2(void*) { return 0; }
int cuCtxPopCurrent_v2(void**) { return 0; }
int cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
  *total = card().free_bytes();
  *free = *total - card().bytes_in_use();
  return 0;
}
int cuMemAlloc_v2(std::uint64_t* address, std::size_t bytes) {
  return attempt([&] { *address = card().allocate(bytes); }, out_of_memory);
}
int cuMemFree_v2(std::uint64_t address) {
  card().free(address);
  return 0;
}
int cuMemcpyHtoDAsync_v2(std::uint64_t to, const void* from, std::size_t bytes, void*) {
  return attempt([&] { card().upload(to, from, bytes); });
}
int cuMemcpyDtoHAsync_v2(void* to, std::uint64_t from, std::size_t bytes, void*) {
  return attempt([&] { card().download(to, from, bytes); });
}
int cuMemsetD8Async(std::uint64_t address, unsigned char value, std::size_t bytes, void*) {
  if (value != 0) return failed;
  return attempt([&] { card().clear(address, bytes); });
}
int cuStreamCreate(void** stream, unsigned) { return give(stream); }
int cuStreamSynchronize(void*) { return 0; }
int cuStreamDestroy_v2(void*) { return 0; }
int cuModuleLoadData(void** module, const void*) { return give(module); }
int cuModuleUnload(void*) { return 0; }
int cuModuleGetFunction(const void** function, void*, const char* name) {
  const auto& kernels = snowshed::methods::mpm::emulated_kernels();
  const auto kernel = kernels.find(name);
  if (kernel == kernels.end()) return not_found;
  *function = kernel->first.c_str();
  return 0;
}
int cuFuncSetAttribute(void*, int, int) { return 0; }
int cuLaunchKernel(const void* function, unsigned blocks, unsigned, unsigned, unsigned threads,
                   unsigned, unsigned, unsigned, void*, void** arguments, void**) {
  return attempt(
      [&] { card().launch(static_cast<const char*>(function), {blocks, threads}, arguments); });
}

}  // extern "C"
