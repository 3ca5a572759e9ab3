#include "snowshed/methods/grains/rotor.hpp"

#include <gtest/gtest.h>

namespace snowshed::methods::grains {
namespace {

const Vec3 moments(1.0, 2.3, 3.1);
const Vec3 momentum(0.4, 2.0, -0.7);

double energy_of(const Orientation& q) {
  const Vec3 l = q.conjugate() * momentum;
  return 0.5 * l.dot(l.cwiseQuotient(moments));
}

Orientation rotate_steps(double dt, int steps) {
  Orientation q(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized());
  for (int i = 0; i < steps; ++i) rotate_freely(q, momentum, moments, dt);
  return q;
}

TEST(Rotor, KeepsTheEnergyOfAnAsymmetricBodyOver1e5Steps) {
  Orientation q = rotate_steps(0, 1);
  const double before = energy_of(q);
  double max_error = 0;
  for (int i = 0; i < 100000; ++i) {
    rotate_freely(q, momentum, moments, 1e-3);
    max_error = std::max(max_error, std::abs(energy_of(q) / before - 1));
  }
  EXPECT_LT(max_error, 1e-6);
  EXPECT_NEAR(q.norm(), 1, 1e-14);
}

TEST(Rotor, IsOfSecondOrder) {
  const Orientation exact = rotate_steps(1.0 / 8192, 16384);
  const double coarse = exact.angularDistance(rotate_steps(1.0 / 32, 64));
  const double fine = exact.angularDistance(rotate_steps(1.0 / 64, 128));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
}

TEST(Rotor, IsTimeReversible) {
  Orientation q = rotate_steps(0.05, 100);
  for (int i = 0; i < 100; ++i) rotate_freely(q, momentum, moments, -0.05);
  EXPECT_LT(q.angularDistance(rotate_steps(0, 1)), 1e-13);
}

TEST(Rotor, ABallTurnsAboutItsMomentum) {
  Orientation q(1, 0, 0, 0);
  // Turning about one axis after the other is exact if the momentum lies along an axis.
  for (int i = 0; i < 10; ++i) rotate_freely(q, Vec3(0, 0, 2), Vec3(4, 4, 4), 0.1);
  EXPECT_LT(q.angularDistance(Orientation(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))), 1e-14);
}

}  // namespace
}  // namespace snowshed::methods::grains
