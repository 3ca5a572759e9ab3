#include "snowshed/core/memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace snowshed {
namespace {

/// ThreadSanitizer shadows all memory with about four times as much.
#ifdef __SANITIZE_THREAD__
constexpr std::uint64_t bytes_per_byte = 6;
#else
constexpr std::uint64_t bytes_per_byte = 2;
#endif

TEST(Memory, PeakGrowsByTheTouchedMemory) {
  constexpr std::uint64_t size = 64 << 20;
  const std::uint64_t before = peak_resident_bytes();
  {
    std::vector<char> touched(size, 1);
    EXPECT_EQ(touched.back(), 1);
  }
  const std::uint64_t after = peak_resident_bytes();
  EXPECT_GT(before, 1u << 20);
  EXPECT_GE(after, size);
  EXPECT_LT(after, before + bytes_per_byte * size);
}

TEST(Memory, AvailableMemoryIsAtMostThePhysicalMemory) {
  EXPECT_GT(physical_memory_bytes(), 256u << 20);
  EXPECT_GT(available_memory_bytes(), 1u << 20);
  EXPECT_LE(available_memory_bytes(), physical_memory_bytes());
}

}  // namespace
}  // namespace snowshed
