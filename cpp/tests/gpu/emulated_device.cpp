#include "gpu/emulated_device.hpp"

#include <setjmp.h>
#include <ucontext.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "gpu/cuda_on_host.hpp"

namespace snowshed::gpu {
namespace emulation {

Index thread, block, threads_of_block, blocks_of_grid;

namespace {

constexpr std::size_t stack_bytes = 128 * 1024;

/// A stack of its own on which threads run, one after the other. After its start, jumps lead to and
/// fro, because a change of context by the system's function costs a call of the kernel.
struct Fiber {
  std::vector<char> stack = std::vector<char>(stack_bytes);
  ucontext_t start;
  jmp_buf paused;
  bool started = false, ended = false, flag = false;
};

jmp_buf scheduler;
Fiber* running;
std::function<void()> body;
int flags_at_barrier;

std::vector<std::unique_ptr<Fiber>>& fibers() {
  static std::vector<std::unique_ptr<Fiber>> all;
  return all;
}

void pause() {
  if (_setjmp(running->paused) == 0) _longjmp(scheduler, 1);
}

void enter() {
  while (true) {
    body();
    running->ended = true;
    pause();
  }
}

void run(Fiber& fiber) {
  running = &fiber;
  if (_setjmp(scheduler) != 0) return;
  if (fiber.started) _longjmp(fiber.paused, 1);
  fiber.started = true;
  getcontext(&fiber.start);
  fiber.start.uc_stack.ss_sp = fiber.stack.data();
  fiber.start.uc_stack.ss_size = fiber.stack.size();
  fiber.start.uc_link = nullptr;
  makecontext(&fiber.start, enter, 0);
  setcontext(&fiber.start);
}

/// Runs each thread that has not ended up to its next barrier. Returns whether any waits there.
bool run_to_barrier(unsigned threads, Turns turns) {
  bool any = false;
  int flags = 0;
  for (unsigned k = 0; k < threads; ++k) {
    const unsigned t = turns == Turns::forwards ? k : threads - 1 - k;
    Fiber& fiber = *fibers()[t];
    if (fiber.ended) continue;
    thread.x = t;
    run(fiber);
    if (fiber.ended) continue;
    any = true;
    flags += fiber.flag;
  }
  flags_at_barrier = flags;
  return any;
}

void set_body(std::function<void()> kernel) { body = std::move(kernel); }

void run_block(unsigned threads, Turns turns) {
  while (fibers().size() < threads) fibers().push_back(std::make_unique<Fiber>());
  for (unsigned t = 0; t < threads; ++t) fibers()[t]->ended = false;
  while (run_to_barrier(threads, turns)) {
  }
}

}  // namespace

int wait_for_block(bool flag) {
  running->flag = flag;
  pause();
  return flags_at_barrier;
}

}  // namespace emulation

EmulatedDevice::~EmulatedDevice() {
  for (const auto& piece : memory_) std::free(reinterpret_cast<void*>(piece.first));
}

/// New memory holds what no kernel may rely on.
Address EmulatedDevice::allocate(std::size_t bytes) {
  void* piece = std::malloc(bytes);
  if (!piece) throw std::runtime_error("no memory for the emulated device");
  std::memset(piece, 0x7f, bytes);
  const Address address = reinterpret_cast<Address>(piece);
  memory_[address] = bytes;
  return address;
}

void EmulatedDevice::free(Address address) noexcept {
  memory_.erase(address);
  std::free(reinterpret_cast<void*>(address));
}

void EmulatedDevice::check(Address address, std::size_t bytes) const {
  auto piece = memory_.upper_bound(address);
  if (piece == memory_.begin()) throw std::out_of_range("no memory of the device");
  --piece;
  if (address + bytes > piece->first + piece->second)
    throw std::out_of_range("beyond a piece of the device's memory");
}

void EmulatedDevice::upload(Address to, const void* from, std::size_t bytes) {
  check(to, bytes);
  std::memcpy(reinterpret_cast<void*>(to), from, bytes);
}

void EmulatedDevice::download(void* to, Address from, std::size_t bytes) {
  check(from, bytes);
  std::memcpy(to, reinterpret_cast<const void*>(from), bytes);
}

void EmulatedDevice::clear(Address address, std::size_t bytes) {
  check(address, bytes);
  std::memset(reinterpret_cast<void*>(address), 0, bytes);
}

void EmulatedDevice::launch(const char* name, LaunchShape shape, void** arguments) {
  const auto kernel = kernels_.find(name);
  if (kernel == kernels_.end()) throw std::invalid_argument("no kernel " + std::string(name));
  ++launches_[name];
  emulation::set_body([&] { kernel->second(arguments); });
  emulation::threads_of_block.x = shape.threads;
  emulation::blocks_of_grid.x = shape.blocks;
  for (unsigned k = 0; k < shape.blocks; ++k) {
    emulation::block.x = turns_ == Turns::forwards ? k : shape.blocks - 1 - k;
    emulation::run_block(shape.threads, turns_);
  }
}

std::size_t EmulatedDevice::bytes_in_use() const {
  std::size_t sum = 0;
  for (const auto& piece : memory_) sum += piece.second;
  return sum;
}

}  // namespace snowshed::gpu
