// A driver for tests: it has the functions of libcuda that the program calls, and the memory of a
// card that does not exist. It records calls and fails on demand. Its one kernel is add_one.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

constexpr int out_of_memory = 2, not_found = 500;
constexpr std::size_t card_bytes = 1000000;

struct State {
  std::string calls;                   // names with a space after each
  std::map<std::string, int> failing;  // results, by function
  std::map<void*, std::size_t> memory;
  int contexts = 0, pushed = 0;
  int cards = 1;

  std::size_t used() const {
    std::size_t sum = 0;
    for (const auto& [address, bytes] : memory) sum += bytes;
    return sum;
  }
};

State state;

/// Records a call and returns its result.
int called(const char* name) {
  state.calls += std::string(name) + " ";
  const auto failing = state.failing.find(name);
  return failing == state.failing.end() ? 0 : failing->second;
}

/// The same for a call that needs a current context.
int called_in_context(const char* name) {
  const int result = called(name);
  return result == 0 && state.pushed == 0 ? 201 : result;
}

void* at(std::uint64_t address) { return reinterpret_cast<void*>(address); }

}  // namespace

extern "C" {

// --- for tests -------------------------------------------------------------------------------

void fake_cuda_fail(const char* function, int result) { state.failing[function] = result; }
void fake_cuda_reset() { state = State(); }
void fake_cuda_set_cards(int cards) { state.cards = cards; }
const char* fake_cuda_calls() { return state.calls.c_str(); }
/// Sum of all that was taken and not given back: bytes, contexts and contexts that are current.
std::size_t fake_cuda_leaks() { return state.used() + state.contexts + state.pushed; }

// --- the driver ------------------------------------------------------------------------------

int cuInit(unsigned) { return called("cuInit"); }
int cuDriverGetVersion(int* version) {
  *version = 13000;
  return called("cuDriverGetVersion");
}
int cuGetErrorName(int result, const char** name) {
  *name = result == out_of_memory ? "CUDA_ERROR_OUT_OF_MEMORY" : "CUDA_ERROR_LAUNCH_FAILED";
  return 0;
}
int cuGetErrorString(int, const char** text) {
  *text = "as the test wants";
  return 0;
}
int cuDeviceGetCount(int* count) {
  *count = state.cards;
  return called("cuDeviceGetCount");
}
int cuDeviceGet(int* device, int ordinal) {
  *device = ordinal;
  return called("cuDeviceGet");
}
int cuDeviceGetName(char* name, int length, int) {
  std::strncpy(name, "Fake card", std::size_t(length));
  return called("cuDeviceGetName");
}
int cuDeviceGetPCIBusId(char* id, int length, int device) {
  std::snprintf(id, std::size_t(length), "0000:%02x:00.0", 23 + device);
  return called("cuDeviceGetPCIBusId");
}
int cuDeviceGetAttribute(int* value, int attribute, int) {
  *value = attribute == 75 ? 9 : 0;
  return called("cuDeviceGetAttribute");
}
int cuDevicePrimaryCtxRetain(void** context, int) {
  *context = &state;
  const int result = called("cuDevicePrimaryCtxRetain");
  if (result == 0) ++state.contexts;
  return result;
}
int cuDevicePrimaryCtxRelease_v2(int) {
  --state.contexts;
  return called("cuDevicePrimaryCtxRelease");
}
int cuCtxPushCurrent_v2(void*) {
  ++state.pushed;
  return 0;
}
int cuCtxPopCurrent_v2(void**) {
  --state.pushed;
  return 0;
}
int cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
  *total = card_bytes;
  *free = card_bytes - state.used();
  return called_in_context("cuMemGetInfo");
}
int cuMemAlloc_v2(std::uint64_t* address, std::size_t bytes) {
  if (const int result = called_in_context("cuMemAlloc")) return result;
  if (state.used() + bytes > card_bytes) return out_of_memory;
  void* const block = std::malloc(bytes);
  state.memory[block] = bytes;
  *address = reinterpret_cast<std::uint64_t>(block);
  return 0;
}
int cuMemFree_v2(std::uint64_t address) {
  state.memory.erase(at(address));
  std::free(at(address));
  return called_in_context("cuMemFree");
}
int cuMemcpyHtoDAsync_v2(std::uint64_t to, const void* from, std::size_t bytes, void*) {
  std::memcpy(at(to), from, bytes);
  return called_in_context("cuMemcpyHtoDAsync");
}
int cuMemcpyDtoHAsync_v2(void* to, std::uint64_t from, std::size_t bytes, void*) {
  std::memcpy(to, at(from), bytes);
  return called_in_context("cuMemcpyDtoHAsync");
}
int cuMemsetD8Async(std::uint64_t address, unsigned char value, std::size_t bytes, void*) {
  std::memset(at(address), value, bytes);
  return called_in_context("cuMemsetD8Async");
}
int cuStreamCreate(void** stream, unsigned) {
  *stream = &state.calls;
  return called_in_context("cuStreamCreate");
}
int cuStreamSynchronize(void*) { return called_in_context("cuStreamSynchronize"); }
int cuStreamDestroy_v2(void*) { return called_in_context("cuStreamDestroy"); }
int cuModuleLoadData(void** module, const void*) {
  *module = &state.memory;
  return called_in_context("cuModuleLoadData");
}
int cuModuleUnload(void*) { return called_in_context("cuModuleUnload"); }
int cuModuleGetFunction(void** function, void*, const char* name) {
  *function = &state.failing;
  if (std::strcmp(name, "add_one") != 0) return not_found;
  return called_in_context("cuModuleGetFunction");
}
int cuFuncSetAttribute(void*, int attribute, int) {
  return called_in_context(attribute == 8 ? "cuFuncSetAttribute" : "wrong attribute");
}
/// The kernel add_one(int* values, int count).
int cuLaunchKernel(void*, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned,
                   void*, void** arguments, void**) {
  int* const values = static_cast<int*>(at(*static_cast<std::uint64_t*>(arguments[0])));
  const int count = *static_cast<int*>(arguments[1]);
  for (int i = 0; i < count; ++i) ++values[i];
  return called_in_context("cuLaunchKernel");
}

}  // extern "C"
