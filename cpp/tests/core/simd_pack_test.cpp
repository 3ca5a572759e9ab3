#include "snowshed/core/simd_pack.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace snowshed {
namespace {

template <class T>
class SimdPackTest : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SimdPackTest, Scalars);

template <class T>
SimdPack<T> ramp(T start) {
  SimdPack<T> v;
  for (int l = 0; l < simd_width<T>; ++l) v[l] = start + T(l);
  return v;
}

TYPED_TEST(SimdPackTest, PartialLoadsRepeatTheFirstValueAndReadNoFurther) {
  using T = TypeParam;
  for (int n = 1; n <= simd_width<T>; ++n) {
    std::vector<T> values;  // exactly n: a read past the end shows under a sanitizer
    for (int i = 0; i < n; ++i) values.push_back(T(10 + i));
    const SimdPack<T> v = load(values.data(), n);
    for (int l = 0; l < simd_width<T>; ++l) EXPECT_EQ(v[l], l < n ? T(10 + l) : T(10));
  }
}

TYPED_TEST(SimdPackTest, PartialStoresLeaveTheRestUnchanged) {
  using T = TypeParam;
  for (int n = 0; n <= simd_width<T>; ++n) {
    std::vector<T> values(simd_width<T> + 1, T(-1));
    store(values.data(), ramp(T(1)), n);
    for (int i = 0; i <= simd_width<T>; ++i) EXPECT_EQ(values[i], i < n ? T(1 + i) : T(-1));
  }
}

TEST(SimdPack, FewerRowsThanLanesAreTransposedInBlocks) {
  typedef double Wide __attribute__((vector_size(8 * sizeof(double))));
  Wide rows[4];
  for (int i = 0; i < 4; ++i)
    for (int l = 0; l < 8; ++l) rows[i][l] = 10 * i + l;
  transpose(rows);
  for (int i = 0; i < 4; ++i)
    for (int l = 0; l < 8; ++l) EXPECT_EQ(rows[i][l], 10 * (l % 4) + l / 4 * 4 + i);
}

TYPED_TEST(SimdPackTest, FunctionsActOnEachLane) {
  using T = TypeParam;
  using V = SimdPack<T>;
  const V a = ramp(T(-1)), b = broadcast<V>(T(0.5));
  for (int l = 0; l < simd_width<T>; ++l) {
    const T x = T(-1 + l);
    EXPECT_EQ(b[l], T(0.5));
    EXPECT_EQ(max(a, b)[l], std::max(x, T(0.5)));
    EXPECT_EQ(min(a, b)[l], std::min(x, T(0.5)));
    EXPECT_EQ(abs(a)[l], std::abs(x));
    EXPECT_EQ(clamp(a, V(b - b), b)[l], std::min(std::max(x, T(0)), T(0.5)));
    EXPECT_EQ(select(a > b, a, b)[l], std::max(x, T(0.5)));
    EXPECT_EQ(sqrt(V(a * a))[l], std::abs(x));
  }
  EXPECT_EQ(largest(a), T(simd_width<T> - 2));
  EXPECT_TRUE(any(a < T(0)));
  EXPECT_TRUE(any(a > T(simd_width<T> - 3)));
  EXPECT_FALSE(any(a < T(-1)));
}

TYPED_TEST(SimdPackTest, ScalarsHaveTheSameFunctions) {
  using T = TypeParam;
  EXPECT_EQ(select(true, T(1), T(2)), T(1));
  EXPECT_EQ(largest(T(3)), T(3));
  EXPECT_EQ(broadcast<T>(T(4)), T(4));
  EXPECT_FALSE(any(T(1) > T(2)));
}

}  // namespace
}  // namespace snowshed
