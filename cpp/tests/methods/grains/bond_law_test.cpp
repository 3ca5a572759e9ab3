#include "snowshed/methods/grains/bond_law.hpp"

#include <gtest/gtest.h>

namespace snowshed::methods::grains {
namespace {

const BondLaw law{200, 50, 3, 2, 0.5};  // N/m, N/m, N, N, 1

ContactMotion<double> motion(double gap, double gap_growth, SimdVec<double> shear,
                             double twist = 0) {
  return {gap, gap_growth, {0, 0, 1}, shear, twist};
}

TEST(BondLaw, ABrokenBondLosesItsStoredEnergyAndTheLastWork) {
  SimdVec<double> u{0.01, 0, 0};
  bool bonded = true;
  // The gap grows from 0.01 to 0.02, where the bond pulls with 4 N and breaks.
  const auto f = law(motion(0.02, 0.01, {0, 0, 0}), u, bonded);
  EXPECT_TRUE(f.tension_break);
  EXPECT_FALSE(bonded);
  EXPECT_EQ(f.normal_force, 0);
  const double stored = 0.5 * 200 * 0.01 * 0.01 + 0.5 * 50 * 0.01 * 0.01;
  const double work = 0.5 * (200 * 0.01 + 0) * 0.01;
  EXPECT_NEAR(f.broken_energy, stored + work, 1e-15);
  EXPECT_EQ(f.heat, 0);
}

TEST(BondLaw, SlidingFrictionProducesHeat) {
  SimdVec<double> u{0, 0, 0};
  bool bonded = false;
  double heat = 0;
  for (int i = 0; i < 100; ++i) {
    const auto f = law(motion(-0.01, 0, {0, 1e-3, 0}), u, bonded);
    heat += f.heat;
    EXPECT_NEAR(f.normal_force, 2, 1e-14);
    EXPECT_LE(f.shear_force.y, 1 + 1e-14);
  }
  // The contact slips at 1 N, after a displacement of the spring by 0.02 m.
  EXPECT_NEAR(50 * u.y, 1, 1e-13);
  EXPECT_NEAR(heat, 1 * (0.1 - 0.02), 1e-12);
}

TEST(BondLaw, SeparatedSpheresLoseTheirShear) {
  SimdVec<double> u{0.01, 0, 0};
  bool bonded = false;
  const auto f = law(motion(0.001, 0.002, {0, 0, 0}), u, bonded);
  EXPECT_FALSE(f.touching);
  EXPECT_EQ(u.x, 0);
  EXPECT_EQ(f.normal_force, 0);
  EXPECT_NEAR(f.heat, 0.5 * 50 * 1e-4, 1e-15);
}

TEST(BondLaw, ShearTurnsWithTheContact) {
  SimdVec<double> u{0.01, 0, 0};
  bool bonded = true;
  law(motion(0, 0, {0, 0, 0}, 0.1), u, bonded);
  EXPECT_NEAR(u.y / u.x, 0.1, 1e-12);
  EXPECT_NEAR(std::hypot(u.x, u.y), 0.01, 1e-15);
  // The normal tilts toward x, so that the shear tilts down.
  ContactMotion<double> tilted = motion(0, 0, {0, 0, 0});
  tilted.normal = {std::sin(0.2), 0, std::cos(0.2)};
  u = {0.01, 0, 0};
  law(tilted, u, bonded);
  EXPECT_NEAR(u.x, 0.01 * std::cos(0.2), 1e-15);
  EXPECT_NEAR(u.z, -0.01 * std::sin(0.2), 1e-15);
}

TEST(BondLaw, ABondWithoutStrengthBearsNoTension) {
  BondLaw weak = law;
  weak.tension_limit = weak.shear_limit = 0;
  SimdVec<double> u{0, 0, 0};
  bool bonded = true;
  EXPECT_FALSE(weak(motion(0, 0, {0, 0, 0}), u, bonded).tension_break) << "nothing pulls";
  EXPECT_TRUE(weak(motion(1e-12, 0, {0, 0, 0}), u, bonded).tension_break);
}

}  // namespace
}  // namespace snowshed::methods::grains
