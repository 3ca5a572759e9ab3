#include "snowshed/methods/mpm/kernels/bspline.hpp"

#include <gtest/gtest.h>

#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::methods::mpm {
namespace {

template <Basis B, class S>
struct SplineCase {
  static constexpr Basis basis = B;
  using Scalar = S;
};

template <class C>
class BSplineWeights : public testing::Test {
 protected:
  using T = typename C::Scalar;
  static constexpr int n = support(C::basis);
  T w[n], g[n];
  void at(double f) { BSpline<C::basis>::evaluate(T(f), w, g); }
  static constexpr double epsilon = std::numeric_limits<T>::epsilon();
};

using SplineCases =
    testing::Types<SplineCase<Basis::quadratic, float>, SplineCase<Basis::quadratic, double>,
                   SplineCase<Basis::cubic, float>, SplineCase<Basis::cubic, double>>;
TYPED_TEST_SUITE(BSplineWeights, SplineCases);

const double fractions[] = {0.0, 1e-9, 0.01, 0.25, 0.4999, 0.5, 0.7, 0.999};

TYPED_TEST(BSplineWeights, AddUpToOne) {
  for (double f : fractions) {
    this->at(f);
    double sum = 0;
    for (auto w : this->w) {
      EXPECT_GE(w, 0);
      sum += w;
    }
    EXPECT_NEAR(sum, 1.0, 4 * this->epsilon);
  }
}

TYPED_TEST(BSplineWeights, GradientsAddUpToZero) {
  for (double f : fractions) {
    this->at(f);
    double sum = 0;
    for (auto g : this->g) sum += g;
    EXPECT_NEAR(sum, 0.0, 4 * this->epsilon);
  }
}

TYPED_TEST(BSplineWeights, ReproduceLinearFields) {
  for (double f : fractions) {
    this->at(f);
    double position = 0, slope = 0;
    for (int k = 0; k < this->n; ++k) {
      position += k * this->w[k];
      slope += k * this->g[k];
    }
    EXPECT_NEAR(position, f + base_offset(TypeParam::basis), 8 * this->epsilon);
    EXPECT_NEAR(slope, 1.0, 8 * this->epsilon);
  }
}

TYPED_TEST(BSplineWeights, WeightsOfStepsGiveTheSameSums) {
  const double values[] = {3.0, -1.0, 4.0, -1.5};
  for (double f : fractions) {
    this->at(f);
    typename TestFixture::T steps[TestFixture::n - 1], slopes[TestFixture::n - 1];
    weights_of_steps(this->w, steps);
    weights_of_steps(this->g, slopes);
    double sum = 0, gradient = 0, by_steps = values[1], gradient_by_steps = 0, total = 0;
    for (int k = 0; k < this->n; ++k) {
      sum += this->w[k] * values[k];
      gradient += this->g[k] * values[k];
    }
    for (int k = 0; k + 1 < this->n; ++k) {
      by_steps += steps[k] * (values[k + 1] - values[k]);
      gradient_by_steps += slopes[k] * (values[k + 1] - values[k]);
      total += slopes[k];
    }
    EXPECT_NEAR(by_steps, sum, 16 * this->epsilon);
    EXPECT_NEAR(gradient_by_steps, gradient, 32 * this->epsilon);
    EXPECT_NEAR(total, 1.0, 4 * this->epsilon);  // values that grow by one per node
  }
}

TYPED_TEST(BSplineWeights, HaveTheSecondMomentOfApic) {
  // sum w (x_i - x)^2 = 1/4 (quadratic), 1/3 (cubic): the D_p that APIC relies on.
  for (double f : fractions) {
    this->at(f);
    double inertia = 0;
    for (int k = 0; k < this->n; ++k)
      inertia += this->w[k] * std::pow(k - f - base_offset(TypeParam::basis), 2);
    EXPECT_NEAR(inertia, TypeParam::basis == Basis::quadratic ? 1.0 / 4 : 1.0 / 3,
                8 * this->epsilon);
  }
}

TYPED_TEST(BSplineWeights, GradientsAreTheDerivatives) {
  constexpr int n = support(TypeParam::basis);
  for (double f : {0.01, 0.3, 0.5, 0.99}) {
    double above[n], below[n], unused[n];
    constexpr double h = 1e-5;
    BSpline<TypeParam::basis>::evaluate(f + h, above, unused);
    BSpline<TypeParam::basis>::evaluate(f - h, below, unused);
    this->at(f);
    for (int k = 0; k < n; ++k)
      EXPECT_NEAR(this->g[k], (above[k] - below[k]) / (2 * h), 1e-9 + 4 * this->epsilon);
  }
}

TYPED_TEST(BSplineWeights, AreContinuousAcrossCells) {
  constexpr int n = support(TypeParam::basis);
  typename TypeParam::Scalar w[n], g[n];
  BSpline<TypeParam::basis>::evaluate(typename TypeParam::Scalar(1), w, g);
  this->at(0);
  for (int k = 0; k + 1 < n; ++k) {
    EXPECT_NEAR(this->w[k], w[k + 1], this->epsilon);
    EXPECT_NEAR(this->g[k], g[k + 1], this->epsilon);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
