// The law of snow with a crack band and a relaxation time: softening, return mapping and
// relaxation.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "material/cam_clay_testing.hpp"
#include "snowshed/core/random.hpp"

namespace snowshed::material {
namespace {

using namespace cam_clay_testing;

constexpr double strength = 7e3;  // Pa, initial p0

template <class T>
RegularisedCamClay<T> banded(double softening, const LawConstants& s = calibrated,
                             int dimension = 3) {
  auto law = RegularisedCamClay<T>::from(s.youngs_modulus, s.poissons_ratio, s.slope, s.cohesion,
                                         s.hardening, dimension);
  law.softening = T(softening);
  law.band_begin = T(law.initial_plastic_strain(strength));
  return law;
}

TEST(CrackBandLaw, DilatedSnowSoftensFasterByTheFactor) {
  const double begin = law_of<double>(calibrated).initial_plastic_strain(strength);
  for (const double s : {0.25, 0.5, 1.0, 4.0}) {
    const auto law = banded<double>(s);
    for (const double ev : {-2.0, -0.2, begin})  // compacted: (1.2.7)
      EXPECT_DOUBLE_EQ(law.preconsolidation(ev), law_of<double>(calibrated).preconsolidation(ev));
    // Fractions of the dilation -e_0/s, at which all strength is lost.
    for (const double part : {0.1, 0.5, 0.9})
      EXPECT_NEAR(law.preconsolidation(begin - part * begin / s),
                  law_of<double>(calibrated).preconsolidation(begin - part * begin),
                  1e-9 * strength);
    EXPECT_EQ(law.preconsolidation(begin - 1.001 * begin / s), 0.0);
    double slope;
    const double at = begin - 0.3 * begin / s, h = 1e-6;
    law.preconsolidation(at, slope);
    EXPECT_NEAR(slope, (law.preconsolidation(at + h) - law.preconsolidation(at - h)) / (2 * h),
                1e-6 * std::abs(slope));
  }
}

/// Expects that the returns of random trials satisfy the yield condition and the volume balance.
template <class T>
void expect_valid_returns() {
  const double eps = std::numeric_limits<T>::epsilon();
  Random random(17);
  int yielded = 0, dilated = 0;
  for (int i = 0; i < 20000; ++i) {
    const double softening = std::pow(10.0, 3 * random.uniform() - 1);  // 0.1 to 100
    const auto law = banded<T>(softening, calibrated, random.uniform() < 0.5 ? 2 : 3);
    const double begin = double(law.band_begin);
    const double end = begin - begin / softening;  // end of strength
    const T ev_old = T(begin + (random.uniform() - 0.5) * 2.2 * std::abs(begin / softening));
    const double scale = 3e4 * std::pow(10.0, -2 * random.uniform());
    PQ<T> s{T(scale * (2 * random.uniform() - 1)), T(scale * random.uniform())};
    const PQ<T> trial = s;
    T ev = ev_old;
    if (!law.return_map(s, ev)) continue;
    ++yielded;
    const double bulk = double(law.elastic.bulk), m2 = double(law.m2), a = 1 + 2 * 0.2;
    const double p0 = double(law.preconsolidation(ev)), p = double(s.p), q = double(s.q);
    const double d = double(ev) - double(ev_old);
    dilated += d > 0;
    const double slope = 0.1 * 833e3 * softening;
    const double stress = scale + p0 + (bulk + slope) * (std::abs(double(ev)) + std::abs(d));
    const double tolerance = 32 * eps * stress;
    ASSERT_TRUE(std::isfinite(p) && std::isfinite(q) && std::isfinite(double(ev)));
    ASSERT_NEAR(p, double(trial.p) + bulk * d, tolerance);
    ASSERT_LE(q, double(trial.q));
    if (double(ev) >= end + 1e-6) {
      ASSERT_NEAR(p, 0, tolerance);
      ASSERT_NEAR(q, 0, tolerance + std::sqrt(tolerance * (p0 + tolerance)));
      continue;
    }
    const double size = m2 * (std::abs(p) + 1.2 * p0) + tolerance;
    const double y = a * q * q + m2 * (p + 0.2 * p0) * (p - p0);
    ASSERT_NEAR(y, 0, 16 * tolerance * size)
        << "s " << softening << " trial " << trial.p << " " << trial.q << " e_v " << ev_old;
  }
  EXPECT_GT(yielded, 5000);
  EXPECT_GT(dilated, 2000);
}

TEST(CrackBandLaw, ReturnsSatisfyYieldConditionAndVolumeBalance) {
  expect_valid_returns<double>();
  expect_valid_returns<float>();
}

TEST(CrackBandLaw, AFactorOfOneIsCamClayBitForBit) {
  Random random(5);
  const auto plain = law_of<float>(calibrated);
  const auto law = banded<float>(1.0);
  for (int i = 0; i < 20000; ++i) {
    PQ<float> a{float(4e4 * (random.uniform() - 0.5)), float(3e4 * random.uniform())}, b = a;
    float ev = float(-0.2 * random.uniform() + 0.02), ev_of_law = ev;
    plain.return_map(a, ev);
    law.return_map(b, ev_of_law);
    ASSERT_EQ(a.p, b.p);
    ASSERT_EQ(a.q, b.q);
    ASSERT_EQ(ev, ev_of_law);
  }
}

/// Snow at constant strain relaxes towards the yield surface: n steps of dt leave
/// (tau / (dt + tau))^n of the overstress, which approaches exp(-t / tau) for short steps.
TEST(Relaxation, OverstressDecaysExponentially) {
  constexpr double tau = 1e-4, time = 1.5e-4;
  const auto law = banded<double>(1.0);
  const double ev = law.initial_plastic_strain(strength);
  // At the centre of the ellipse the flow has no volume, so q alone relaxes.
  const double center = 0.5 * (1 - 0.2) * strength;
  PQ<double> on_surface{center, 3 * strength};
  double ev_on_surface = ev;
  ASSERT_TRUE(law.return_map(on_surface, ev_on_surface));
  for (const int steps : {50, 500}) {
    const double dt = time / steps, overstress = tau / (dt + tau);
    PQ<double> s{center, 3 * strength};
    double ev_now = ev;
    for (int n = 0; n < steps; ++n) law.return_map(s, ev_now, overstress);
    const double remaining = (s.q - on_surface.q) / (3 * strength - on_surface.q);
    EXPECT_NEAR(remaining, std::pow(overstress, steps), 1e-6);
    EXPECT_NEAR(remaining, std::exp(-time / tau), 0.5 * dt / tau);
    EXPECT_NEAR(s.p, center, 1e-6 * strength);
  }
}

/// A partial return keeps the volume balance, and lies between the trial and the surface.
TEST(Relaxation, PartialReturnsKeepTheVolumeBalance) {
  Random random(3);
  const auto law = banded<double>(0.5);
  int yielded = 0;
  for (int i = 0; i < 5000; ++i) {
    const PQ<double> trial{3e4 * (2 * random.uniform() - 1), 3e4 * random.uniform()};
    const double before = -0.1 * random.uniform(), overstress = random.uniform();
    PQ<double> back = trial, part = trial;
    double ev_back = before, ev_part = before;
    if (!law.return_map(back, ev_back)) continue;
    ++yielded;
    law.return_map(part, ev_part, overstress);
    ASSERT_NEAR(part.p, back.p + overstress * (trial.p - back.p), 1e-6);
    ASSERT_NEAR(part.q, back.q + overstress * (trial.q - back.q), 1e-6);
    ASSERT_NEAR(part.p - trial.p, law.elastic.bulk * (ev_part - before), 1e-5);
  }
  EXPECT_GT(yielded, 1000);
}

}  // namespace
}  // namespace snowshed::material
