#include "core/allocation_fault.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"

namespace snowshed {
namespace {

std::atomic<std::int64_t> allocations_left{0};  // until the failure; 0: none planned, -1: over

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (allocations_left > 0 && --allocations_left == 0) {
    allocations_left = -1;
    throw std::bad_alloc();
  }
  void* p = nullptr;
  if (posix_memalign(&p, alignment, bytes > 0 ? bytes : 1) != 0) throw std::bad_alloc();
  // In all tests of this program, floating-point numbers are NaN until they are written. Zeros
  // would hide reads of memory that has not been written.
  std::memset(p, 0xff, bytes);
  return p;
}

}  // namespace

AllocationFault::AllocationFault(std::int64_t n) { allocations_left = n; }
AllocationFault::~AllocationFault() { allocations_left = 0; }
bool AllocationFault::happened() { return allocations_left < 0; }

FaultOutcome with_allocation_fault(std::int64_t n, const std::function<void()>& call) {
  const AllocationFault fault(n);
  try {
    call();
  } catch (const std::bad_alloc&) {
    return FaultOutcome::failed;
  }
  return AllocationFault::happened() ? FaultOutcome::recovered : FaultOutcome::no_fault;
}

}  // namespace snowshed

void* operator new(std::size_t bytes) {
  return snowshed::allocate(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return snowshed::allocate(bytes, std::size_t(alignment));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace snowshed {
namespace {

TEST(AllocationFault, FreshMemoryHoldsNan) {
  AlignedVector<double> values(3);
  for (const double value : values) EXPECT_TRUE(std::isnan(value));
}

TEST(AllocationFault, OnlyTheNthAllocationFails) {
  std::vector<std::vector<int>> blocks(4);
  AlignedVector<float> aligned;
  const AllocationFault fault(3);
  blocks[0].resize(10);
  EXPECT_FALSE(AllocationFault::happened());
  aligned.resize(10);
  EXPECT_THROW(blocks[1].resize(10), std::bad_alloc);
  EXPECT_TRUE(AllocationFault::happened());
  blocks[1].resize(10);
}

}  // namespace
}  // namespace snowshed
