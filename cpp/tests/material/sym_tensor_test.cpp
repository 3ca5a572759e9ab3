#include "snowshed/material/sym_tensor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "snowshed/core/random.hpp"

// A vector type as template argument loses its alignment, which does not matter here.
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace snowshed::material {
namespace {

// The reference is computed in long double, so that its own rounding is negligible.
template <int D>
using Matrix = Eigen::Matrix<long double, D, D>;

/// Returns f of a symmetric matrix, computed from its eigenvalues.
template <int D, class F>
Matrix<D> matrix_function(const Matrix<D>& a, F f) {
  const Eigen::SelfAdjointEigenSolver<Matrix<D>> eigen(a);
  Eigen::Matrix<long double, D, 1> w = eigen.eigenvalues();
  for (int i = 0; i < D; ++i) w[i] = f(w[i]);
  return eigen.eigenvectors() * w.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Returns the tensor in a lane of packs, or the tensor itself if its components are scalars.
template <class V, int D>
Matrix<D> lane(const Sym<V, D>& a, int l) {
  Matrix<D> m;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      if constexpr (is_simd_pack<V>)
        m(i, j) = a(i, j)[l];
      else
        m(i, j) = a(i, j);
    }
  return m;
}

template <class V, int D_>
struct TensorCase {
  using Value = V;
  static constexpr int D = D_;
};

template <class C>
class SymTensor : public testing::Test {
 protected:
  using V = typename C::Value;
  using T = Scalar<V>;
  static constexpr int D = C::D;
  static constexpr int lanes = is_simd_pack<V> ? int(sizeof(V) / sizeof(T)) : 1;
  static constexpr double epsilon = std::numeric_limits<T>::epsilon();

  /// Returns random tensors, each of the given norm.
  static Sym<V, D> random_tensor(Random& random, double norm) {
    Sym<V, D> a;
    for (int l = 0; l < lanes; ++l) {
      double c[Sym<V, D>::size], squared = 0;
      for (int k = 0; k < a.size; ++k) {
        c[k] = 2 * random.uniform() - 1;
        squared += (k < D ? 1 : 2) * c[k] * c[k];
      }
      for (int k = 0; k < a.size; ++k) {
        const T value = T(c[k] * norm / std::sqrt(squared));
        if constexpr (is_simd_pack<V>)
          a.c[k][l] = value;
        else
          a.c[k] = value;
      }
    }
    return a;
  }

  /// Returns the largest error over random tensors of that norm, relative to the norm of the
  /// result.
  template <class F, class G>
  static double max_error(double norm, F f, G exact) {
    Random random(2);
    double error = 0;
    for (int i = 0; i < 300; ++i) {
      const Sym<V, D> a = random_tensor(random, norm), b = f(a);
      for (int l = 0; l < lanes; ++l) {
        const Matrix<D> expected = matrix_function<D>(lane(a, l), exact);
        error = std::max(error, double((lane(b, l) - expected).norm() / expected.norm()));
      }
    }
    return error;
  }
};

using TensorCases =
    testing::Types<TensorCase<float, 2>, TensorCase<float, 3>, TensorCase<double, 2>,
                   TensorCase<double, 3>, TensorCase<SimdPack<float>, 2>,
                   TensorCase<SimdPack<float>, 3>, TensorCase<SimdPack<double>, 2>,
                   TensorCase<SimdPack<double>, 3>>;
TYPED_TEST_SUITE(SymTensor, TensorCases);

// Below detail::series_norm = 0.1 (half of it for the strain) series are used, above it
// eigenvalues.
constexpr double norms[] = {1e-12, 1e-6, 1e-3, 0.0499, 0.0501, 0.0999, 0.1001, 0.3, 0.9};

TYPED_TEST(SymTensor, HenckyStrainIsHalfTheLogarithm) {
  for (double norm : norms)
    EXPECT_LT(this->max_error(
                  norm, [](const auto& a) { return hencky_strain(a); },
                  [](long double x) { return std::log1p(x) / 2; }),
              16 * this->epsilon)
        << norm;
}

TYPED_TEST(SymTensor, CauchyGreenIsTheExponential) {
  for (double norm : {1e-12, 1e-6, 1e-3, 0.0499, 0.0501, 0.0999, 0.1001, 0.3, 0.9, 3.0})
    EXPECT_LT(this->max_error(
                  norm, [](const auto& a) { return cauchy_green_minus_identity(a); },
                  [](long double x) { return std::expm1(2 * x); }),
              32 * this->epsilon)
        << norm;
}

TYPED_TEST(SymTensor, LogarithmUndoesExponential) {
  Random random(3);
  for (double norm : {1e-6, 0.01, 0.03, 0.5})
    for (int i = 0; i < 100; ++i) {
      const auto e = this->random_tensor(random, norm);
      const auto back = hencky_strain(cauchy_green_minus_identity(e));
      for (int l = 0; l < this->lanes; ++l)
        EXPECT_LT(double((lane(back, l) - lane(e, l)).norm()), 32 * this->epsilon * norm);
    }
}

TYPED_TEST(SymTensor, HandlesEqualEigenvaluesAndZero) {
  using V = typename TypeParam::Value;
  using T = Scalar<V>;
  for (double x : {0.0, 1e-3, 0.5, -0.5}) {
    Sym<V, TypeParam::D> a{};
    for (int k = 0; k < TypeParam::D; ++k) a.c[k] = broadcast<V>(T(x));
    const auto e = lane(hencky_strain(a), 0);
    const Matrix<TypeParam::D> expected =
        std::log1p(static_cast<long double>(T(x))) / 2 * Matrix<TypeParam::D>::Identity();
    EXPECT_LE(double((e - expected).norm()), 4 * this->epsilon * std::abs(x));
  }
}

TYPED_TEST(SymTensor, InvariantsMatchTheMatrix) {
  Random random(4);
  const auto a = this->random_tensor(random, 1.0);
  for (int l = 0; l < this->lanes; ++l) {
    const auto m = lane(a, l);
    const auto at = [l](const auto& v) {
      if constexpr (is_simd_pack<typename TypeParam::Value>)
        return double(v[l]);
      else
        return double(v);
    };
    EXPECT_NEAR(at(trace(a)), double(m.trace()), 4 * this->epsilon);
    EXPECT_NEAR(at(norm_squared(a)), double(m.squaredNorm()), 4 * this->epsilon);
    EXPECT_NEAR(at(determinant(a)), double(m.determinant()), 8 * this->epsilon);
    EXPECT_LT(double((lane(square(a), l) - m * m).norm()), 8 * this->epsilon);
  }
}

}  // namespace
}  // namespace snowshed::material
