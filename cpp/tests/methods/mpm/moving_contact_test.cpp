// Moving obstacles: the nodes in them, the velocities of these nodes, and the conditions under
// which obstacles carry snow.
#include <gtest/gtest.h>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/mpm/boundary.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double cell = 0.01;

/// A half space below a plane through the origin that turns about a point beside it.
Obstacle turning_ground() {
  Obstacle ground = fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::slip, 0.3);
  geometry::MotionSpec motion;
  motion.angular_velocity = Vec3(0, 2, 0);
  motion.pivot = Vec3(0.02, 0, 0);
  motion.velocity = Vec3(0.1, 0, 0);
  ground.motion.emplace(motion);
  return ground;
}

TEST(MovingContact, NodesInATurningObstacleHaveItsNormalAndVelocity) {
  const Obstacle ground = turning_ground();
  const double time = 0.3, angle = 2 * time;
  const Boundary<double, 2> boundary({ground}, cell);
  const BlockCoord<2> block{0, -1};
  auto contacts = Contacts<double, 2>().relocated(boundary, {block_key<2>(block)}, time);
  ASSERT_GT(contacts.count(0), 8);
  const Vec3 normal(std::sin(angle), 0, std::cos(angle)), pivot(0.02 + 0.1 * time, 0, 0);
  for (int i = 0; i < contacts.count(0); ++i) {
    const Contact<double>& c = contacts.of_block(0)[i];
    const Vec3 x(cell * (c.node / 8), 0, cell * (c.node % 8 - 8));
    const Vec3 velocity = Vec3(0.1, 0, 0) + Vec3(0, 2, 0).cross(x - pivot);
    EXPECT_NEAR(c.normal[0], normal.x(), 1e-12);
    EXPECT_NEAR(c.normal[1], normal.z(), 1e-12);
    EXPECT_NEAR(c.velocity[0], velocity.x(), 1e-12);
    EXPECT_NEAR(c.velocity[1], velocity.z(), 1e-12);
  }
}

TEST(MovingContact, ASlipperyPlateLiftsSnow) {
  for (const Condition condition : {Condition::slip, Condition::separate}) {
    Obstacle plate = fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), condition);
    geometry::MotionSpec motion;
    motion.velocity = Vec3(0.4, 0, 0.5);
    plate.motion.emplace(motion);
    const auto solver = make_solver(options_for({2, Precision::float32}, cell), {plate});
    solver->add(filled_box(2, Vec3(0, 0, 0.003), Vec3(0.08, 0, 0.033), 0.005));
    const Vec3 start = weighted_mean(solver->state(), solver->state().positions);
    run_until(*solver, 0.1);
    const Vec3 displacement = weighted_mean(solver->state(), solver->state().positions) - start;
    EXPECT_NEAR(displacement.z(), 0.5 * solver->time(), 0.003);
    EXPECT_NEAR(displacement.x(), 0.0, 0.003);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
