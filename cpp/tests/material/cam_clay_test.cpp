#include "snowshed/material/cam_clay.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "material/rate_integration.hpp"
#include "snowshed/core/random.hpp"

// A vector type as template argument loses its alignment, which does not matter here.
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace snowshed {
namespace {

constexpr MaterialConstants calibrated{1e6, 0.3, 0.5, 0.2, 0.1};

template <class T>
CamClay<T> material(const MaterialConstants& s, int dimension = 3) {
  return CamClay<T>::from(s.youngs_modulus, s.poissons_ratio, s.slope, s.cohesion, s.hardening,
                          dimension);
}

// --- hardening --------------------------------------------------------------------------------

TEST(CamClayHardening, FollowsTheHyperbolicSine) {
  const auto snow = material<double>(calibrated);
  const double bulk = 1e6 / (3 - 6 * 0.3);
  for (double ev : {-3.0, -0.5, -0.084, -1e-3, -1e-9})
    EXPECT_NEAR(snow.preconsolidation(ev), bulk * std::sinh(-0.1 * ev),
                1e-14 * bulk * std::sinh(-0.1 * ev));
  EXPECT_EQ(snow.preconsolidation(0.0), 0.0);
  EXPECT_EQ(snow.preconsolidation(0.3), 0.0);
}

TEST(CamClayHardening, SlopeIsItsDerivative) {
  const auto snow = material<double>({1e6, 0.2, 0.5, 0.2, 2.0});
  for (double ev : {-1.0, -0.1, -1e-2}) {
    double slope;
    snow.preconsolidation(ev, slope);
    const double h = 1e-5, rise = snow.preconsolidation(ev + h) - snow.preconsolidation(ev - h);
    EXPECT_NEAR(slope, rise / (2 * h), 1e-8 * std::abs(slope));  // O(h^2)
  }
  double slope;
  snow.preconsolidation(0.1, slope);
  EXPECT_EQ(slope, 0.0);
}

TEST(CamClayHardening, InitialStrainGivesTheWantedPressure) {
  // xi = 0.1, p0 = 7 kPa, E = 1 MPa: 8.4 % of dilation removes all strength.
  EXPECT_NEAR(material<double>(calibrated).initial_plastic_strain(7e3), -0.084, 5e-5);
  for (double xi : {1e-3, 0.1, 1.0, 50.0})
    for (double p0 : {0.0, 1e-3, 7e3, 1e6}) {
      const auto snow = material<double>({1e6, 0.3, 0.5, 0.2, xi});
      EXPECT_NEAR(snow.preconsolidation(snow.initial_plastic_strain(p0)), p0, 1e-13 * p0);
    }
}

// --- one return -------------------------------------------------------------------------------

/// A trial state and what became of it.
struct Return {
  MaterialConstants snow;
  int dimension;
  double p_trial, q_trial, ev_old, p, q, ev;
};

std::ostream& operator<<(std::ostream& out, const Return& r) {
  return out << r.dimension << "D E " << r.snow.youngs_modulus << " nu " << r.snow.poissons_ratio
             << " M " << r.snow.slope << " beta " << r.snow.cohesion << " xi " << r.snow.hardening
             << ": trial p " << r.p_trial << " q " << r.q_trial << " e_v " << r.ev_old << " -> p "
             << r.p << " q " << r.q << " e_v " << r.ev;
}

/// What backward Euler with associative flow demands of a return, to the round-off of T: the
/// yield condition, the flow rule, the volume balance, and dissipation.
template <class T>
void expect_sound(const Return& r) {
  MaterialConstants s = r.snow;
  s.slope = std::max(s.slope, 1e-4);  // as CamClay::from
  const double eps = std::numeric_limits<T>::epsilon();
  const RateEquations snow(s, r.dimension);
  const double p0 = snow.p0(r.ev), d = r.ev - r.ev_old;
  const double m2 = s.slope * s.slope, a = 1 + 2 * s.cohesion;
  // Round-off of the numbers the result is made from: stress, and e_v through p0.
  const double stress = std::abs(r.p_trial) + p0 + snow.bulk * (std::abs(r.ev) + std::abs(d)) +
                        std::abs(snow.p0_slope(r.ev)) * (std::abs(r.ev) + std::abs(r.ev_old));
  const double tolerance = 16 * eps * stress;

  ASSERT_TRUE(std::isfinite(r.p) && std::isfinite(r.q) && std::isfinite(r.ev)) << r;
  EXPECT_GE(r.q, 0.0) << r;
  EXPECT_LE(r.q, r.q_trial) << r;
  EXPECT_NEAR(r.p, r.p_trial + snow.bulk * d, tolerance) << r;

  const double p_work = -r.p * d, q_work = r.q * (r.q_trial - r.q) / (3 * snow.mu);
  EXPECT_GE(p_work + q_work, -4 * tolerance * (std::abs(d) + tolerance / snow.bulk)) << r;

  const double y_old =
      a * r.q_trial * r.q_trial +
      m2 * (r.p_trial + s.cohesion * snow.p0(r.ev_old)) * (r.p_trial - snow.p0(r.ev_old));
  const double size = m2 * (std::abs(r.p) + (1 + s.cohesion) * p0) + tolerance * m2;
  const double y = a * r.q * r.q + m2 * (r.p + s.cohesion * p0) * (r.p - p0);
  if (r.p == r.p_trial && r.q == r.q_trial && d == 0) {  // elastic
    EXPECT_LE(y_old, 16 * tolerance * size) << r;
    return;
  }
  EXPECT_NEAR(y, 0.0, 16 * tolerance * size) << r;
  // q (N - c D) = q_tr N with N = y_p/M^2, c = 6 mu (1 + 2 beta)/M^2; at the origin any q flows.
  if (r.p == 0 && r.q == 0) return;
  const double n = 2 * r.p - (1 - s.cohesion) * p0, c = 6 * snow.mu * a / m2;
  const double q_error = tolerance + std::sqrt(tolerance * size / a);
  EXPECT_NEAR(r.q * (n - c * d), r.q_trial * n,
              16 * (r.q_trial * tolerance + (std::abs(n) + c * std::abs(d)) * q_error +
                    c * r.q * tolerance / snow.bulk))
      << r;
}

/// x to the precision of T. Volatile because GCC 12 takes the conversion of a pair of numbers to
/// float and back for nothing at all.
template <class T>
double rounded(double x) {
  volatile T r = T(x);
  return double(r);
}

template <class T>
Return returned(const MaterialConstants& snow, int dimension, double p, double q, double ev) {
  Return r{snow, dimension, rounded<T>(p), rounded<T>(q), rounded<T>(ev), 0, 0, 0};
  PQ<T> s{T(r.p_trial), T(r.q_trial)};
  T e = T(r.ev_old);
  material<T>(snow, dimension).return_map(s, e);
  r.p = double(s.p), r.q = double(s.q), r.ev = double(e);
  return r;
}

/// One of the listed values.
double pick(Random& random, std::initializer_list<double> values) {
  return values
      .begin()[std::min(values.size() - 1, std::size_t(random.uniform() * double(values.size())))];
}

/// Random snow, e_v and trial, corners included.
Return random_trial(Random& random) {
  Return r{};
  r.dimension = random.uniform() < 0.5 ? 2 : 3;
  r.snow = {pick(random, {1e4, 1e6, 1e7}), pick(random, {0, 0.2, 0.3, 0.45, 0.49}),
            pick(random, {0, 0.1, 0.5, 1.0, 1.5}), pick(random, {0, 0.05, 0.2, 0.5, 1.0}),
            pick(random, {1e-3, 0.01, 0.1, 1.0, 10.0, 50.0})};
  const RateEquations snow(r.snow, r.dimension);
  const double initial =
      -std::asinh(pick(random, {0, 1e-3, 50, 7e3, 1e5}) / snow.hardening) / r.snow.hardening;
  r.ev_old = std::max(-1 / r.snow.hardening, initial) +
             pick(random, {0, 0, 1e-9, 1e-3, 0.1, 0.5}) * (random.uniform() - 0.5);
  // Elastic strains of the trial, from tiny to as large as p0 stays a finite float.
  const double largest = std::min(10.0, 30 / r.snow.hardening);
  const auto strain = [&] {
    return pick(random, {0, 1, 1, 1}) * std::min(largest, std::pow(10.0, 9 * random.uniform() - 8));
  };
  r.p_trial = snow.bulk * strain() * (random.uniform() < 0.5 ? -1 : 1);
  r.q_trial = 3 * snow.mu * strain();
  return r;
}

template <class T>
class CamClayReturn : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(CamClayReturn, Scalars);

TYPED_TEST(CamClayReturn, IsSoundForRandomTrials) {
  Random random(3);
  for (int i = 0; i < 100000 && !this->HasFailure(); ++i) {
    const Return t = random_trial(random);
    expect_sound<TypeParam>(
        returned<TypeParam>(t.snow, t.dimension, t.p_trial, t.q_trial, t.ev_old));
  }
}

TYPED_TEST(CamClayReturn, IsSoundOnTheCentreLine) {
  Random random(4);
  for (int i = 0; i < 1000 && !this->HasFailure(); ++i) {
    const Return t = random_trial(random);
    const double p0 = RateEquations(t.snow, t.dimension).p0(t.ev_old);
    const double centre = (1 - t.snow.cohesion) * p0 / 2;
    for (double shear : {0.0, 0.1, 1.0, 1.001, 1e3})
      expect_sound<TypeParam>(
          returned<TypeParam>(t.snow, t.dimension, centre, shear * p0, t.ev_old));
  }
}

TYPED_TEST(CamClayReturn, LeavesElasticTrialsAlone) {
  const double p0 = 7e3, ev = material<double>(calibrated).initial_plastic_strain(p0);
  for (double p : {-0.19 * p0, 0.0, 0.4 * p0, 0.99 * p0}) {
    const Return r = returned<TypeParam>(calibrated, 3, p, 1e-3 * p0, ev);
    EXPECT_EQ(r.p, r.p_trial);
    EXPECT_EQ(r.q, r.q_trial);
    EXPECT_EQ(r.ev, r.ev_old);
  }
}

TYPED_TEST(CamClayReturn, KeepsTheVolumeOnTheCentreLine) {
  // Purely deviatoric flow: q falls to the critical state, p and e_v stay.
  const double p0 = 7e3, ev = material<double>(calibrated).initial_plastic_strain(p0);
  const Return r = returned<TypeParam>(calibrated, 3, 0.4 * p0, 3 * p0, ev);
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  EXPECT_NEAR(r.p, 0.4 * p0, 10 * eps * p0);
  EXPECT_NEAR(r.ev, ev, 10 * eps);
  EXPECT_NEAR(r.q, 0.5 * 1.2 * p0 / (2 * std::sqrt(1.4)), 1e3 * eps * p0);
}

TYPED_TEST(CamClayReturn, SnowWithoutStrengthKeepsNoStressAndItsVolume) {
  // p0 = 0 and tension or shear: the particle separates freely and e_v gathers the opening.
  const double bulk = RateEquations(calibrated, 3).bulk;
  const Return open = returned<TypeParam>(calibrated, 3, -0.01 * bulk, 500.0, 0.02);
  EXPECT_EQ(open.p, 0.0);
  EXPECT_EQ(open.q, 0.0);
  EXPECT_NEAR(open.ev, 0.03, 1e-8);
  // Half of the gap closed again: still no stress.
  const Return half = returned<TypeParam>(calibrated, 3, 0.015 * bulk, 500.0, 0.03);
  EXPECT_EQ(half.p, 0.0);
  EXPECT_EQ(half.q, 0.0);
  EXPECT_NEAR(half.ev, 0.015, 1e-8);
  // The whole gap and more: it carries again.
  const Return closed = returned<TypeParam>(calibrated, 3, 0.05 * bulk, 0.0, 0.03);
  EXPECT_GT(closed.p, 0.0);
  EXPECT_LT(closed.ev, 0.0);
  EXPECT_NEAR(closed.p, RateEquations(calibrated, 3).p0(closed.ev), 1e-5 * closed.p);
}

TYPED_TEST(CamClayReturn, TensionBeyondTheStrengthSoftensToNothingInOneReturn) {
  const double bulk = RateEquations(calibrated, 3).bulk;
  const double ev = material<double>(calibrated).initial_plastic_strain(7e3);  // -0.084
  const Return r = returned<TypeParam>(calibrated, 3, -0.2 * bulk, 0.1 * bulk, ev);
  EXPECT_EQ(r.p, 0.0);
  EXPECT_EQ(r.q, 0.0);
  EXPECT_NEAR(r.ev, ev + 0.2, 1e-7);
}

TEST(CamClay, ReturnsToTheNearestPointOfASmoothPath) {
  // Where softening is gentler than the elastic bulk modulus (beta xi < 1) a return to the origin
  // must mean that no point of the surface lies on the way there.
  Random random(5);
  int origins = 0;
  for (int i = 0; i < 20000; ++i) {
    const Return t = random_trial(random);
    if (t.snow.cohesion * t.snow.hardening >= 1) continue;
    const Return r = returned<double>(t.snow, t.dimension, t.p_trial, t.q_trial, t.ev_old);
    if (r.p != 0 || r.q != 0 || r.ev <= 0 || r.ev_old >= 0) continue;
    ++origins;
    const RateEquations snow(t.snow, t.dimension);
    const double m2 = std::max(1e-8, t.snow.slope * t.snow.slope), a = 1 + 2 * t.snow.cohesion;
    for (int k = 1; k < 200; ++k) {
      const double d = -t.ev_old * k / 200, p = t.p_trial + snow.bulk * d,
                   p0 = snow.p0(t.ev_old + d);
      const double n = 2 * p - (1 - t.snow.cohesion) * p0;
      const double q = t.q_trial * n / (n - 6 * snow.mu * a / m2 * d);
      ASSERT_GT(a * q * q + m2 * (p + t.snow.cohesion * p0) * (p - p0), 0) << r;
    }
  }
  EXPECT_GT(origins, 100);
}

template <class T>
void expect_lanes_agree(double tolerance) {
  Random random(6);
  using V = SimdPack<T>;
  constexpr int W = simd_width<T>;
  for (int i = 0; i < 20000; ++i) {
    const Return common = random_trial(random);  // one snow, a different trial in each lane
    const RateEquations snow(common.snow, common.dimension);
    PQ<V> s;
    V ev;
    Return scalar[W];
    for (int l = 0; l < W; ++l) {
      const double f = std::pow(0.5, l);
      scalar[l] = returned<T>(common.snow, common.dimension, f * common.p_trial, common.q_trial / f,
                              common.ev_old);
      s.p[l] = T(scalar[l].p_trial);
      s.q[l] = T(scalar[l].q_trial);
      ev[l] = T(scalar[l].ev_old);
    }
    material<T>(common.snow, common.dimension).return_map(s, ev);
    for (int l = 0; l < W; ++l) {
      const Return& r = scalar[l];
      const double stress = std::abs(r.p_trial) + r.q_trial +
                            std::abs(snow.p0_slope(r.ev)) * (std::abs(r.ev) + std::abs(r.ev_old));
      ASSERT_NEAR(double(s.p[l]), r.p, tolerance * stress) << r;
      ASSERT_NEAR(double(s.q[l]), r.q, std::sqrt(tolerance) * stress) << r;
      ASSERT_NEAR(double(ev[l]), r.ev, tolerance * (stress / snow.bulk + std::abs(r.ev))) << r;
    }
  }
}

TEST(CamClay, LanesReturnAsScalarsDo) {
  // Different exp and log only: some units in the last place, amplified where the surface is steep.
  expect_lanes_agree<double>(1e-13);
  expect_lanes_agree<float>(3e-5);
}

// --- along strain paths -----------------------------------------------------------------------

template <int D>
using Tensor = Eigen::Matrix<double, D, D>;

/// Backward Euler: n returns along each straight piece of a path of strain increments.
template <class T, int D>
MaterialState<D> by_returns(const MaterialConstants& constants, MaterialState<D> start,
                            const std::vector<Tensor<D>>& path, int n) {
  const CamClay<T> snow = material<T>(constants, D);
  const double bulk = double(snow.elastic.bulk), mu = double(snow.elastic.mu);
  T ev = T(start.ev);
  Tensor<D> e = start.strain;
  for (const Tensor<D>& piece : path)
    for (int i = 0; i < n; ++i) {
      e += piece / n;
      const Tensor<D> dev = e - e.trace() / D * Tensor<D>::Identity();
      const double q_trial = 2 * mu * std::sqrt(1.5) * dev.norm();
      PQ<T> s{T(-bulk * e.trace()), T(q_trial)};
      if (!snow.return_map(s, ev)) continue;
      e = -double(s.p) / (bulk * D) * Tensor<D>::Identity() +
          (q_trial > 0 ? double(s.q) / q_trial : 1.0) * dev;
    }
  return {e, double(ev)};
}

/// Distance of two states relative to the strain at which the snow yields.
template <int D>
double distance(const MaterialState<D>& a, const MaterialState<D>& b, double yield_strain) {
  return std::max((a.strain - b.strain).norm(), std::abs(a.ev - b.ev)) / yield_strain;
}

/// The returns converge at first order to the rate equations, and the limit they converge to
/// (by Richardson extrapolation: first-order errors halve with the step) is theirs to 1e-6.
template <int D>
void expect_convergence(const MaterialConstants& constants, double p0,
                        const std::vector<Tensor<D>>& path) {
  const RateEquations snow(constants, D);
  const double yield_strain = p0 / snow.bulk;
  const MaterialState<D> start{Tensor<D>::Zero(),
                               -std::asinh(p0 / snow.hardening) / constants.hardening};
  MaterialState<D> exact = start;
  for (const Tensor<D>& piece : path) exact = snow.integrate(exact, piece);
  const auto coarse = by_returns<double, D>(constants, start, path, 2000);
  const auto middle = by_returns<double, D>(constants, start, path, 4000);
  const auto fine = by_returns<double, D>(constants, start, path, 8000);
  const MaterialState<D> limit{2 * fine.strain - middle.strain, 2 * fine.ev - middle.ev};
  EXPECT_LT(distance(limit, exact, yield_strain), 1e-6);
  const double error_coarse = distance(coarse, exact, yield_strain);
  const double error_fine = distance(fine, exact, yield_strain);
  EXPECT_LT(error_coarse, 0.02);
  if (error_fine > 1e-8) {  // else the path has no error of first order
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

TYPED_TEST(CamClayPaths, IsotropicCompaction) {
  this->check(Paths<TypeParam::value>::isotropic_compaction());
}
TYPED_TEST(CamClayPaths, Oedometric) { this->check(Paths<TypeParam::value>::oedometric()); }
TYPED_TEST(CamClayPaths, DrainedTriaxial) {
  this->check(Paths<TypeParam::value>::drained_triaxial());
}
TYPED_TEST(CamClayPaths, ConstantVolumeShear) {
  this->check(Paths<TypeParam::value>::constant_volume_shear());
}
TYPED_TEST(CamClayPaths, DilatingShear) { this->check(Paths<TypeParam::value>::dilating_shear()); }
TYPED_TEST(CamClayPaths, Unloading) { this->check(Paths<TypeParam::value>::unloading()); }
TYPED_TEST(CamClayPaths, Tension) { this->check(Paths<TypeParam::value>::tension()); }
TYPED_TEST(CamClayPaths, TensionToFullSoftening) {
  this->check(Paths<TypeParam::value>::tension_to_full_softening());
}
TYPED_TEST(CamClayPaths, RecompactionOfStrengthlessSnow) {
  this->check(Paths<TypeParam::value>::recompaction());
}
TYPED_TEST(CamClayPaths, RandomPolylines) {
  constexpr int D = TypeParam::value;
  Random random(7);
  for (int i = 0; i < 4; ++i) {
    typename Paths<D>::Path path{Paths<D>::isotropic(-0.02)};
    for (int k = 0; k < 4; ++k) path.push_back(Paths<D>::random(random, 0.01));
    this->check(path);
  }
}

TEST(CamClay, LongShearEndsInTheCriticalState) {
  // Without cohesion q = M p there, whatever the start; the volume no longer changes.
  const MaterialConstants snow{1e6, 0.3, 0.7, 0.0, 0.5};
  const MaterialState<3> start{Eigen::Matrix3d::Zero(), -0.02};
  const auto end = by_returns<double, 3>(
      snow, start, {Paths<3>::isotropic(-0.01), Paths<3>::triaxial(1.0)}, 20000);
  const RateEquations rate(snow, 3);
  EXPECT_NEAR(rate.q<3>(end.strain) / rate.p<3>(end.strain), 0.7, 1e-6);
  EXPECT_NEAR(rate.p<3>(end.strain), rate.p0(end.ev) / 2, 1e-5 * rate.p0(end.ev));
}

TEST(CamClay, IsotropicCompactionFollowsTheHardeningLaw) {
  // p = p0(e_v) with elastic and plastic volume adding up to the strain imposed: one equation.
  const RateEquations rate(calibrated, 3);
  const double ev0 = material<double>(calibrated).initial_plastic_strain(7e3), imposed = -0.1;
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
}  // namespace snowshed
