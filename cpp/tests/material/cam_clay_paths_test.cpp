// The return mapping along strain paths, compared with the rate equations.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "material/cam_clay_testing.hpp"
#include "snowshed/core/random.hpp"

namespace snowshed::material {
namespace {

using namespace cam_clay_testing;

template <int D>
using Tensor = Eigen::Matrix<double, D, D>;

/// Returns the state after a path of strain increments, each cut into n backward Euler steps.
template <class T, int D>
MaterialState<D> by_returns(const LawConstants& constants, MaterialState<D> start,
                            const std::vector<Tensor<D>>& path, int n) {
  const CamClay<T> snow = law_of<T>(constants, D);
  const double bulk = double(snow.elastic.bulk), mu = double(snow.elastic.mu);
  T ev = T(start.ev);
  Tensor<D> e = start.strain;
  for (const Tensor<D>& increment : path)
    for (int i = 0; i < n; ++i) {
      e += increment / n;
      const Tensor<D> dev = e - e.trace() / D * Tensor<D>::Identity();
      const double q_trial = 2 * mu * std::sqrt(1.5) * dev.norm();
      PQ<T> s{T(-bulk * e.trace()), T(q_trial)};
      if (!snow.return_map(s, ev)) continue;
      e = -double(s.p) / (bulk * D) * Tensor<D>::Identity() +
          (q_trial > 0 ? double(s.q) / q_trial : 1.0) * dev;
    }
  return {e, double(ev)};
}

/// Returns the distance of two states relative to the strain at which the snow yields.
template <int D>
double distance(const MaterialState<D>& a, const MaterialState<D>& b, double yield_strain) {
  return std::max((a.strain - b.strain).norm(), std::abs(a.ev - b.ev)) / yield_strain;
}

/// Expects that the returns converge at first order to the solution of the rate equations.
/// Richardson extrapolation gives their limit, which must agree to 1e-6.
template <int D>
void expect_convergence(const LawConstants& constants, double p0,
                        const std::vector<Tensor<D>>& path) {
  const RateEquations snow(constants, D);
  const double yield_strain = p0 / snow.bulk;
  const MaterialState<D> start{Tensor<D>::Zero(),
                               -std::asinh(p0 / snow.hardening) / constants.hardening};
  MaterialState<D> exact = start;
  for (const Tensor<D>& increment : path) exact = snow.integrate(exact, increment);
  const auto coarse = by_returns<double, D>(constants, start, path, 2000);
  const auto middle = by_returns<double, D>(constants, start, path, 4000);
  const auto fine = by_returns<double, D>(constants, start, path, 8000);
  const MaterialState<D> limit{2 * fine.strain - middle.strain, 2 * fine.ev - middle.ev};
  EXPECT_LT(distance(limit, exact, yield_strain), 1e-6);
  const double error_coarse = distance(coarse, exact, yield_strain);
  const double error_fine = distance(fine, exact, yield_strain);
  EXPECT_LT(error_coarse, 0.02);
  if (error_fine > 1e-8) {  // otherwise the path has no first-order error
    EXPECT_NEAR(error_coarse / error_fine, 4.0, 0.4);
  }
  // Single precision, with steps as large as the solver's.
  const auto single = by_returns<float, D>(constants, start, path, 2000);
  EXPECT_LT(distance(single, coarse, yield_strain), 5e-3);
}

template <int D>
struct Paths {
  using Path = std::vector<Tensor<D>>;
  static Tensor<D> axial(double strain) {
    Tensor<D> e = Tensor<D>::Zero();
    e(D - 1, D - 1) = strain;
    return e;
  }
  static Tensor<D> isotropic(double strain) { return strain / D * Tensor<D>::Identity(); }
  /// Axial compression at constant volume.
  static Tensor<D> triaxial(double strain) { return axial(-strain) + isotropic(strain); }
  static Tensor<D> shear(double strain) {
    Tensor<D> e = Tensor<D>::Zero();
    e(0, 1) = e(1, 0) = strain / 2;
    return e;
  }
  static Tensor<D> random(Random& random, double strain) {
    Tensor<D> e = Tensor<D>::NullaryExpr([&] { return 2 * random.uniform() - 1; });
    return strain * (e + e.transpose()) / 2;
  }

  static Path isotropic_compaction() { return {isotropic(-0.05)}; }
  static Path oedometric() { return {axial(-0.05)}; }
  static Path drained_triaxial() { return {isotropic(-0.004), triaxial(0.03) + isotropic(-0.01)}; }
  static Path constant_volume_shear() { return {isotropic(-0.006), shear(0.04)}; }
  static Path dilating_shear() { return {shear(0.02) + isotropic(0.004)}; }
  static Path unloading() { return {axial(-0.03), axial(0.005), axial(-0.01), shear(0.02)}; }
  static Path tension() { return {isotropic(0.03)}; }
  static Path tension_to_full_softening() { return {axial(0.15), shear(0.01)}; }
  static Path recompaction() {
    return {axial(0.15), isotropic(-0.05), shear(0.02) + axial(-0.12), axial(-0.01)};
  }
};

template <class Dimension>
class CamClayPaths : public testing::Test {
 protected:
  static constexpr int D = Dimension::value;
  void check(const typename Paths<D>::Path& path) {
    expect_convergence<D>(calibrated, 7e3, path);
    expect_convergence<D>({2e6, 0.0, 1.2, 0.05, 1.0}, 3e3, path);
    expect_convergence<D>({1e6, 0.4, 0.3, 0.0, 0.5}, 8e3, path);
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CamClayPaths, Dimensions);

TYPED_TEST(CamClayPaths, IsotropicCompactionConverges) {
  this->check(Paths<TypeParam::value>::isotropic_compaction());
}
TYPED_TEST(CamClayPaths, OedometricCompressionConverges) {
  this->check(Paths<TypeParam::value>::oedometric());
}
TYPED_TEST(CamClayPaths, DrainedTriaxialCompressionConverges) {
  this->check(Paths<TypeParam::value>::drained_triaxial());
}
TYPED_TEST(CamClayPaths, ConstantVolumeShearConverges) {
  this->check(Paths<TypeParam::value>::constant_volume_shear());
}
TYPED_TEST(CamClayPaths, DilatingShearConverges) {
  this->check(Paths<TypeParam::value>::dilating_shear());
}
TYPED_TEST(CamClayPaths, UnloadingConverges) { this->check(Paths<TypeParam::value>::unloading()); }
TYPED_TEST(CamClayPaths, TensionConverges) { this->check(Paths<TypeParam::value>::tension()); }
TYPED_TEST(CamClayPaths, TensionToFullSofteningConverges) {
  this->check(Paths<TypeParam::value>::tension_to_full_softening());
}
TYPED_TEST(CamClayPaths, RecompactionOfStrengthlessSnowConverges) {
  this->check(Paths<TypeParam::value>::recompaction());
}
TYPED_TEST(CamClayPaths, RandomPathsConverge) {
  constexpr int D = TypeParam::value;
  Random random(7);
  for (int i = 0; i < 4; ++i) {
    typename Paths<D>::Path path{Paths<D>::isotropic(-0.02)};
    for (int k = 0; k < 4; ++k) path.push_back(Paths<D>::random(random, 0.01));
    this->check(path);
  }
}

TEST(CamClay, LongShearEndsInTheCriticalState) {
  // In the critical state the volume no longer changes. Without cohesion, q = M p.
  const LawConstants snow{1e6, 0.3, 0.7, 0.0, 0.5};
  const MaterialState<3> start{Eigen::Matrix3d::Zero(), -0.02};
  const auto end = by_returns<double, 3>(
      snow, start, {Paths<3>::isotropic(-0.01), Paths<3>::triaxial(1.0)}, 20000);
  const RateEquations rate(snow, 3);
  EXPECT_NEAR(rate.q<3>(end.strain) / rate.p<3>(end.strain), 0.7, 1e-6);
  EXPECT_NEAR(rate.p<3>(end.strain), rate.p0(end.ev) / 2, 1e-5 * rate.p0(end.ev));
}

TEST(CamClay, IsotropicCompactionFollowsTheHardeningLaw) {
  // p = p0(e_v), and the elastic and plastic volume changes add up to the imposed strain. Together
  // these are one equation for e_v.
  const RateEquations rate(calibrated, 3);
  const double ev0 = law_of<double>(calibrated).initial_plastic_strain(7e3), imposed = -0.1;
  const auto end = by_returns<double, 3>(calibrated, {Eigen::Matrix3d::Zero(), ev0},
                                         {Paths<3>::isotropic(imposed)}, 100);
  double low = ev0 + imposed, high = ev0;  // p0 falls, the elastic pressure rises with e_v
  for (int i = 0; i < 100; ++i) {
    const double ev = (low + high) / 2;
    (rate.p0(ev) > -rate.bulk * (imposed - (ev - ev0)) ? low : high) = ev;
  }
  EXPECT_NEAR(end.ev, low, 1e-12);
}

}  // namespace
}  // namespace snowshed::material
