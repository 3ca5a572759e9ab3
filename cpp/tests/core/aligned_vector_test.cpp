#include "snowshed/core/aligned_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace snowshed {
namespace {

TEST(AlignedVector, StartsOnACacheLine) {
  for (const std::size_t n : {1u, 3u, 1000u}) {
    const AlignedVector<double> vector(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(vector.data()) % 64, 0u);
  }
}

TEST(AlignedVector, SharedMemoryOutlivesTheVector) {
  std::shared_ptr<const int> before, after;
  {
    AlignedVector<int> vector(100, 7);
    before = share(vector);
    vector.resize(100000, 8);  // moves to other memory
    EXPECT_NE(before.get(), vector.data());
    after = share(vector);
    EXPECT_EQ(after.get(), vector.data());
  }
  EXPECT_EQ(before.get()[99], 7);
  EXPECT_EQ(after.get()[99999], 8);
}

TEST(AlignedVector, AnEmptyVectorSharesNothing) {
  EXPECT_EQ(share(AlignedVector<float>()), nullptr);
}

}  // namespace
}  // namespace snowshed
