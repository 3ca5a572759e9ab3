#include "snowshed/core/simd_math.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "snowshed/core/random.hpp"

namespace snowshed {
namespace {

template <class T>
class SimdMath : public testing::Test {
 protected:
  static constexpr double epsilon = std::numeric_limits<T>::epsilon();

  /// Largest relative error of f against `exact` on random arguments with the given sign, from lo
  /// to hi, whose logarithms are uniformly distributed.
  template <class F, class G>
  static double max_error(double lo, double hi, double sign, F f, G exact) {
    Random random(1);
    double error = 0;
    for (int i = 0; i < 50000; ++i) {
      SimdPack<T> x;
      for (int l = 0; l < simd_width<T>; ++l)
        x[l] = T(sign * lo * std::pow(hi / lo, random.uniform()));
      const SimdPack<T> y = f(x);
      for (int l = 0; l < simd_width<T>; ++l) {
        const long double expected = exact(static_cast<long double>(x[l]));
        error = std::max(error, double(std::abs((y[l] - expected) / expected)));
      }
    }
    return error;
  }
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SimdMath, Scalars);

long double exact_log1p(long double x) { return std::log1p(x); }
long double exact_expm1(long double x) { return std::expm1(x); }

TYPED_TEST(SimdMath, Log1pIsAccurateToAFewUnitsInTheLastPlace) {
  using V = SimdPack<TypeParam>;
  const auto f = [](const V& x) { return log1p(x); };
  EXPECT_LT(this->max_error(1e-25, 1e30, 1, f, exact_log1p), 4 * this->epsilon);
  EXPECT_LT(this->max_error(1e-25, 0.9999, -1, f, exact_log1p), 4 * this->epsilon);
}

TYPED_TEST(SimdMath, Expm1IsAccurateToAFewUnitsInTheLastPlace) {
  using V = SimdPack<TypeParam>;
  const auto f = [](const V& x) { return expm1(x); };
  const double limit = sizeof(TypeParam) == 4 ? 86 : 707;
  EXPECT_LT(this->max_error(1e-30, limit, 1, f, exact_expm1), 6 * this->epsilon);
  EXPECT_LT(this->max_error(1e-30, limit, -1, f, exact_expm1), 6 * this->epsilon);
}

TYPED_TEST(SimdMath, SmallArgumentsAreReturnedExactly) {
  for (double x : {0.0, 1e-20, -1e-20, 1e-30}) {
    const auto v = broadcast<SimdPack<TypeParam>>(TypeParam(x));
    EXPECT_EQ(log1p(v)[0], TypeParam(x));
    EXPECT_EQ(expm1(v)[0], TypeParam(x));
  }
}

TYPED_TEST(SimdMath, Expm1StaysFiniteForAnyArgument) {
  using V = SimdPack<TypeParam>;
  const auto huge = broadcast<V>(TypeParam(1e30));
  EXPECT_TRUE(std::isfinite(expm1(huge)[0]));
  EXPECT_EQ(expm1(V(-huge))[0], TypeParam(-1));
}

TYPED_TEST(SimdMath, ExpAndLogAreInverse) {
  using T = TypeParam;
  for (double x : {-0.5, -0.01, 1e-6, 0.02, 0.7, 5.0}) {
    const auto v = broadcast<SimdPack<T>>(T(x));
    EXPECT_NEAR(double(log1p(expm1(v))[0]), double(T(x)), 8 * this->epsilon * std::abs(x));
  }
}

}  // namespace
}  // namespace snowshed
