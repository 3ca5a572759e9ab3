#include "snowshed/geometry/rigid_motion.hpp"

#include "geometry/geometry_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

MotionSpec tumbling() {
  MotionSpec spec;
  spec.velocity = {1, 0, -0.5};
  spec.angular_velocity = {0.3, -2, 0.1};
  spec.pivot = {0.5, 0.1, 2};
  spec.start = 1.0;
  spec.end = 3.0;
  return spec;
}

TEST(RigidMotion, RestsBeforeItsStartAndAfterItsEnd) {
  const RigidMotion motion(tumbling());
  const Vec3 x(3, 1, 1);
  EXPECT_LT((motion.to_body(x, 0.5) - x).norm(), 1e-15);
  EXPECT_TRUE(motion.velocity(x, 0.5).isZero(0));
  EXPECT_TRUE(motion.velocity(x, 3.0).isZero(0));
  EXPECT_LT((motion.to_body(x, 3.0) - motion.to_body(x, 99.0)).norm(), 1e-15);
  EXPECT_GT((motion.to_body(x, 3.0) - x).norm(), 0.1);
}

TEST(RigidMotion, VelocityIsTheTimeDerivativeOfAMaterialPoint) {
  const RigidMotion motion(tumbling());
  const Vec3 material(1, -1, 3);
  const double t = 2.2, h = 1e-6;
  const Vec3 x = motion.at(t).to_world(material);
  const Vec3 rate =
      (motion.at(t + h).to_world(material) - motion.at(t - h).to_world(material)) / (2 * h);
  EXPECT_LT((motion.velocity(x, t) - rate).norm(), 1e-8);
  EXPECT_LT((motion.to_body(x, t) - material).norm(), 1e-12);
}

TEST(RigidMotion, TurnsAboutAMovingPivot) {
  MotionSpec spec;
  spec.velocity = {2, 0, 0};
  spec.angular_velocity = {0, pi / 2, 0};  // turns the x axis towards -z
  spec.pivot = {1, 0, 0};
  const RigidMotion motion(spec);
  EXPECT_LT((motion.to_body({3, 0, -1}, 1.0) - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((motion.normal_to_world(Vec3::UnitX(), 1.0) + Vec3::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace snowshed::geometry
