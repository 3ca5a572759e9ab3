// Differences between sticky, slip and separate: snow pulled off an obstacle, and a slab that
// reaches beyond an edge.
#include <gtest/gtest.h>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/geometry/bounds.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double cell = 0.01;

/// A block of elastic snow, 4 cells high, that rests on level ground.
std::unique_ptr<Solver> block_on(const ContactLaw& law, double gravity, const Vec3& velocity) {
  Options o = options_for({2, Precision::float32}, cell);
  o.gravity = gravity;
  o.snows[0].model = material::SnowModel::elastic;
  auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), law.condition, law.friction)});
  ParticleBatch block = filled_box(2, Vec3::Zero(), Vec3(0.08, 0, 0.04), cell / 2);
  block.velocity = velocity;
  solver->add(block);
  return solver;
}

/// Mean position of the lowest layer: the particles that were below half a cell at the start.
Vec3 foot(const ParticleState& now, const ParticleState& start) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < start.positions.size(); ++i) {
    if (start.positions[i].z() > cell / 2) continue;
    sum += now.positions[i];
    ++count;
  }
  return sum / count;
}

struct PullResult {
  Vec3 foot, velocity;  // m, displacement of the lowest layer; m/s, mean of all particles
};

/// Motion of snow that is thrown up and along the ground.
PullResult pulled_off(Condition condition, double duration) {
  const auto solver = block_on({condition, 0.0}, 0.0, Vec3(0.3, 0, 0.3));
  const ParticleState start = solver->state();
  run_until(*solver, duration);
  return {foot(solver->state(), start) - foot(start, start), mean_velocity(*solver)};
}

TEST(Conditions, PulledSnowLeavesOnlyWithSeparate) {
  constexpr double t = 0.1;
  const PullResult separate = pulled_off(Condition::separate, t);
  EXPECT_NEAR(separate.foot.x(), 0.3 * t, 0.01 * t);
  EXPECT_NEAR(separate.foot.z(), 0.3 * t, 0.01 * t);
  EXPECT_NEAR(separate.velocity.z(), 0.3, 0.003);

  const PullResult slip = pulled_off(Condition::slip, t);
  EXPECT_NEAR(slip.foot.x(), 0.3 * t, 0.01 * t);
  EXPECT_NEAR(slip.velocity.x(), 0.3, 0.003);
  EXPECT_LT(std::abs(slip.foot.z()), 0.1 * cell);

  const PullResult sticky = pulled_off(Condition::sticky, t);
  EXPECT_LT(sticky.foot.norm(), 0.1 * cell);
}

// Only snow that presses on an obstacle feels friction, not snow that slip holds against its
// weight.
TEST(Conditions, SnowHangingWithSlipFeelsNoFriction) {
  for (const double gravity : {9.81, -9.81}) {
    const auto solver = block_on({Condition::slip, 0.5}, gravity, Vec3(0.3, 0, 0));
    run_until(*solver, 0.05);
    EXPECT_NEAR(mean_velocity(*solver).x(), gravity > 0 ? 0.3 - 0.5 * 9.81 * 0.05 : 0.3, 0.02)
        << gravity;
  }
}

/// A slab of elastic snow, 20 cm long, that lies on a level shelf and reaches 12 cm beyond its
/// edge, so that its weight turns it over the edge unless its rear is held. Returns how far its
/// middle has sunk after a third of a second, m.
double drop_over_the_edge(Condition condition) {
  Options o = options_for({2, Precision::float32}, cell);
  o.snows[0].model = material::SnowModel::elastic;
  const geometry::Shape shelf = geometry::make_box(Vec3(-0.5, 0, -0.05), Vec3(1, 1e9, 0.1));
  const auto solver = make_solver(o, {fixed(shelf, condition, 0.8)});
  solver->add(filled_box(2, Vec3(-0.08, 0, 0), Vec3(0.12, 0, 0.04), cell / 2));
  run_until(*solver, 0.33);
  const ParticleState s = solver->state();
  return 0.02 - weighted_mean(s, s.positions).z();
}

TEST(Conditions, ASlabTipsOverAnEdgeOnlyWithSeparate) {
  EXPECT_GT(drop_over_the_edge(Condition::separate), 0.1);
  EXPECT_LT(drop_over_the_edge(Condition::slip), 0.01);  // the slab bends
  EXPECT_LT(drop_over_the_edge(Condition::sticky), 0.01);
}

// Snow leaves a panel with slip only over its edge. The edge must not hold it.
TEST(Conditions, SnowOnAPanelWithSlipLeavesOverTheEdge) {
  const double tilt = radians(40), length = 0.2;
  const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), slope(std::cos(tilt), 0, -std::sin(tilt));
  const geometry::Shape panel =
      geometry::make_plate(-0.5 * length * slope, normal, length, geometry::infinity, 0.02);
  const auto solver =
      make_solver(options_for({2, Precision::float32}, cell), {fixed(panel, Condition::slip, 0.3)});
  ParticleBatch slab = filled_box(2, Vec3(-0.15, 0, 0), Vec3(-0.05, 0, 0.03), cell / 2);
  for (Vec3& x : slab.positions) x = x.x() * slope + x.z() * normal;
  solver->add(slab);
  run_until(*solver, 0.5);
  for (const Vec3& x : solver->state().positions) {
    ASSERT_GT(x.dot(slope), 2 * cell);
    ASSERT_LT(x.z(), -0.2);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
