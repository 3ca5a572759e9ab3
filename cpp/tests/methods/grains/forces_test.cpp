// Forces of grains in given poses, against closed forms.
#include "snowshed/methods/grains/forces.hpp"

#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"

namespace snowshed::methods::grains {
namespace {

constexpr double diameter = test_voxel, face = diameter * diameter;

/// Two blocks of n x n x 2 voxels, one on top of the other, in a wide box.
Options bonded_blocks(std::size_t n) {
  return grains_of(image_of(n + 4, n + 4, 8, [n](std::size_t i, std::size_t j, std::size_t k) {
    if (i < 2 || j < 2 || i >= n + 2 || j >= n + 2 || k < 2 || k >= 6) return 0;
    return k < 4 ? 1 : 2;
  }));
}

double normal_stiffness(const Options& o) { return o.settings.elastic_modulus * 0.5 * diameter; }

TEST(Forces, AStretchedBondBreaksAtStrengthTimesArea) {
  for (const std::size_t n : {1, 3, 5}) {
    const Options o = bonded_blocks(n);
    const double limit = o.settings.tensile_strength * face / normal_stiffness(o);
    const double load = double(n * n) * face * o.settings.tensile_strength;
    PosedGrains grains(o);
    grains.state.bodies[1].position.z() += limit * (1 - 1e-10);
    grains.evaluate();
    EXPECT_NEAR(grains.state.bodies[0].force.z() / load, 1, 2e-10);
    EXPECT_NEAR(grains.state.bodies[1].force.z() / load, -1, 2e-10);
    EXPECT_EQ(grains.state.bonds, std::int64_t(n * n));
    grains.state.bodies[1].position.z() += limit * 2e-10;
    grains.evaluate();
    EXPECT_EQ(grains.state.broken_in_tension, std::int64_t(n * n));
    EXPECT_EQ(grains.state.bonds, 0);
    EXPECT_EQ(grains.state.bodies[0].force, Vec3::Zero());
    grains.state.bodies[1].position.z() -= 0.5 * limit;
    grains.evaluate();
    EXPECT_EQ(grains.state.bodies[0].force, Vec3::Zero()) << "a broken bond stays broken";
  }
}

TEST(Forces, ACompressedContactPushesInProportionToItsOverlap) {
  const Options o = bonded_blocks(3);
  PosedGrains grains(o);
  grains.state.bodies[1].position.z() -= 0.01 * diameter;
  grains.evaluate();
  EXPECT_NEAR(grains.state.bodies[1].force.z() / (9 * normal_stiffness(o) * 0.01 * diameter), 1,
              1e-10);
}

/// A bond of n x n pairs bent by an angle about an axis through its middle. The spheres of a
/// pair at y from the axis are 2 (r cos(angle / 2) + y sin(angle / 2)) apart along the bisector of
/// the two bodies. They touch at y cos(angle / 2) - r sin(angle / 2) from the axis. Both are exact
/// for any angle.
struct BentBond {
  std::size_t n;
  double stiffness, half;  // N/m, half the angle

  double offset(std::size_t i) const { return (double(i) - 0.5 * double(n - 1)) * diameter; }
  double gap(double y) const {
    const double lost = std::sin(0.5 * half);
    return 2 * y * std::sin(half) - 2 * diameter * lost * lost;
  }
  double moment() const {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      sum += gap(offset(i)) * (offset(i) * std::cos(half) - 0.5 * diameter * std::sin(half));
    return double(n) * stiffness * sum;
  }
  /// Half the angle at which the outer pairs have this gap, rad.
  static double half_angle(std::size_t n, double gap) {
    BentBond bond{n, 0, gap / (double(n - 1) * diameter)};
    for (int k = 0; k < 20; ++k)
      bond.half += (gap - bond.gap(bond.offset(n - 1))) / (double(n - 1) * diameter);
    return bond.half;
  }
};

TEST(Forces, ABentBondBreaksFirstAtItsOuterPairs) {
  for (const std::size_t n : {2, 4, 7})
    for (const double strength : {1e6, 1e3}) {
      Options o = bonded_blocks(n);
      o.settings.tensile_strength = strength;
      const double limit = strength * face / normal_stiffness(o);
      for (const double share : {1 - 1e-7, 1 + 1e-7}) {
        PosedGrains grains(o);
        GrainBody& upper = grains.state.bodies[1];
        const Vec3 hinge = upper.position - Vec3(0, 0, diameter);  // middle of the bond
        const BentBond bond{n, normal_stiffness(o), BentBond::half_angle(n, share * limit)};
        const Orientation turn(Eigen::AngleAxisd(2 * bond.half, Vec3::UnitX()));
        upper.position = hinge + turn * Vec3(upper.position - hinge);
        upper.orientation = turn * upper.orientation;
        grains.evaluate();
        if (share > 1) {
          EXPECT_EQ(grains.state.broken_in_tension, std::int64_t(n)) << "one row";
          continue;
        }
        EXPECT_EQ(grains.state.bonds, std::int64_t(n * n));
        const GrainBody& lower = grains.state.bodies[0];
        const Vec3 moment = lower.torque + (lower.position - hinge).cross(lower.force);
        const double rounding = 1e-13 * diameter / limit;
        EXPECT_NEAR(moment.x() / bond.moment(), 1, std::max(1e-10, rounding));
        // For small angles the moment is (n + 1) / n times that of a beam.
        const double side = double(n) * diameter;
        const double linear = double(n + 1) / double(n) * strength * side * side * side / 6;
        EXPECT_NEAR(bond.moment() / linear, 1, 2e-7 + limit / diameter);
      }
    }
}

TEST(Forces, AShearedBondBreaksAtStrengthTimesArea) {
  for (const std::size_t n : {1, 4}) {
    Options o = bonded_blocks(n);
    o.settings.shear_strength = 3e5;
    const double limit =
        o.settings.shear_strength * face / (o.settings.stiffness_ratio * normal_stiffness(o));
    const double load = double(n * n) * face * o.settings.shear_strength;
    for (const bool beyond : {false, true}) {
      PosedGrains grains(o);
      grains.state.bodies[1].velocity.x() = limit * (beyond ? 1 + 1e-10 : 1 - 1e-10);
      grains.evaluate(1.0);
      EXPECT_EQ(grains.state.broken_in_shear, beyond ? std::int64_t(n * n) : 0);
      if (beyond)
        EXPECT_EQ(grains.state.bodies[0].force, Vec3::Zero()) << "nothing presses, no friction";
      else
        EXPECT_NEAR(grains.state.bodies[0].force.x() / load, 1, 2e-10);
    }
  }
}

TEST(Forces, PressureRaisesTheShearLimitAndFrictionRemains) {
  Options o = bonded_blocks(3);
  o.settings.friction = 0.4;
  const double overlap = 1e-3 * diameter, push = normal_stiffness(o) * overlap;
  const double shear_limit = o.settings.shear_strength * face + 0.4 * push;
  const double reach = shear_limit / (o.settings.stiffness_ratio * normal_stiffness(o));
  PosedGrains grains(o);
  grains.state.bodies[1].position.z() -= overlap;
  grains.state.bodies[1].velocity.x() = reach * (1 - 1e-9);
  grains.evaluate(1.0);
  EXPECT_EQ(grains.state.bonds, 9);
  EXPECT_NEAR(grains.state.bodies[0].force.x() / (9 * shear_limit), 1, 2e-9);
  grains.state.bodies[1].velocity.x() = reach * 2e-9;
  grains.evaluate(1.0);
  EXPECT_EQ(grains.state.broken_in_shear, 9);
  EXPECT_NEAR(grains.state.bodies[0].force.x() / (9 * 0.4 * push), 1, 1e-10);
}

TEST(Forces, ActionEqualsReactionInForceAndMoment) {
  PosedGrains grains(bonded_blocks(3));
  GrainBody &a = grains.state.bodies[0], &b = grains.state.bodies[1];
  b.position += Vec3(2e-8, -3e-8, 1e-8);
  b.orientation = Orientation(Eigen::AngleAxisd(1e-4, Vec3(1, 2, 3).normalized())) * b.orientation;
  b.velocity = Vec3(1e-8, 2e-8, 0);
  grains.evaluate(1.0);
  EXPECT_GT(a.force.norm(), 0);
  EXPECT_LT((a.force + b.force).norm(), 1e-13 * a.force.norm());
  const Vec3 moment = a.torque + b.torque + a.position.cross(a.force) + b.position.cross(b.force);
  EXPECT_LT(moment.norm(), 1e-12 * a.torque.norm());
}

TEST(Forces, ShearTurnsWithThePair) {
  const Options o = bonded_blocks(2);
  PosedGrains grains(o);
  grains.state.bodies[1].velocity.x() = 1e-9;
  grains.evaluate(1.0);
  const double before = grains.state.bodies[0].force.x();
  // Both bodies turn together, in small steps, by a right angle about z, and the force turns with
  // them.
  const int steps = 2000;
  const double angle = 0.5 * 3.14159265358979323846 / steps;
  for (GrainBody& body : grains.state.bodies) body.velocity.setZero();
  for (int i = 0; i < steps; ++i) {
    for (std::size_t g = 0; g < 2; ++g) {
      GrainBody& body = grains.state.bodies[g];
      body.orientation = Orientation(Eigen::AngleAxisd(angle, Vec3::UnitZ())) * body.orientation;
      const Vec3 l = body.orientation.conjugate() * Vec3(0, 0, angle);
      body.spin_momentum = body.orientation * Vec3(l.cwiseProduct(grains.model.grains[g].inertia));
    }
    grains.evaluate(1.0);
  }
  EXPECT_NEAR(grains.state.bodies[0].force.y() / before, 1, 1e-3);
  EXPECT_NEAR(grains.state.bodies[0].force.x() / before, 0, 1e-3);
}

TEST(Forces, PlatesAndWallsPushLikeSpheresOfTheSameSize) {
  Options o = grains_of(image_of(3, 3, 3, [](auto, auto, auto) { return 1; }));
  PosedGrains grains(o);
  grains.evaluate();
  EXPECT_LT(grains.state.bodies[0].force.norm(), 1e-12);  // the grain fills the box exactly
  const double push = 9 * normal_stiffness(o) * 1e-8;
  grains.state.boundary.plate[1].z() -= 1e-8;
  grains.state.boundary.side[0] += 1e-8;
  grains.evaluate();
  EXPECT_NEAR(grains.state.bodies[0].force.z() / push, -1, 1e-6);
  EXPECT_NEAR(grains.state.bodies[0].force.x() / push, 1, 1e-6);
  EXPECT_NEAR(grains.state.boundary.plate_force[1].z() / push, 1, 1e-6);
  EXPECT_NEAR(grains.state.boundary.side_force[0] / push, 1, 1e-6);
}

}  // namespace
}  // namespace snowshed::methods::grains
