// Contact by touch: snow rests on obstacles, not above them, and past their edges nothing holds it.
#include "snowshed/methods/mpm/touch.hpp"

#include <gtest/gtest.h>

#include <set>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

Options touching_options(const SolverVariant& variant, double dx = 0.01) {
  Options o = options_for(variant, dx);
  o.settings.transfer = Transfer::affine_flip;
  o.settings.damping_length = 0.01;
  o.settings.damping_rate = 380;
  o.settings.contact = ContactRule::touch;
  return o;
}

double lowest(const ParticleState& s) {
  double z = 1e9;
  for (const Vec3& x : s.positions) z = std::min(z, x.z());
  return z;
}

/// Gap (in cells) between the ground and a slab that fell on it.
double resting_gap(const SolverVariant& variant, double dx, ContactRule contact,
                   const Obstacle& ground, double surface) {
  Options o = touching_options(variant, dx);
  o.settings.contact = contact;
  const auto solver = make_solver(o, {ground});
  const double spacing = dx / 2.5, thickness = 2 * dx;
  solver->add(filled_box(variant.dimension, Vec3(0, 0, surface + 2.3 * dx),
                         Vec3(6 * dx, 4 * dx, surface + 2.3 * dx + thickness), spacing));
  run_until(*solver, std::sqrt(6 * dx / 9.81) + 0.08);
  return (lowest(solver->state()) - 0.5 * spacing - surface) / dx;
}

class RestingGap : public testing::TestWithParam<Condition> {};
INSTANTIATE_TEST_SUITE_P(Touch, RestingGap,
                         testing::Values(Condition::sticky, Condition::slip, Condition::separate));

/// The gap is small wherever the surface lies between the nodes, also on a plate thinner than a
/// cell.
TEST_P(RestingGap, IsLessThanATenthOfACell) {
  const Condition condition = GetParam();
  for (const double dx : {0.02, 0.005})
    for (const double surface : {0.0, 0.37 * dx, 0.81 * dx}) {
      const Obstacle ground =
          fixed(geometry::make_plane(Vec3(0, 0, surface), Vec3::UnitZ()), condition, 0.3);
      const Obstacle plate = fixed(
          geometry::make_box(Vec3(0, 0, surface - dx / 4), Vec3(2, 2, dx / 2)), condition, 0.3);
      const SolverVariant variant{2, Precision::float32};
      for (const Obstacle& obstacle : {ground, plate})
        EXPECT_NEAR(resting_gap(variant, dx, ContactRule::touch, obstacle, surface), 0, 0.11)
            << dx << " m, " << surface;
      if (surface == 0)
        EXPECT_GT(resting_gap(variant, dx, ContactRule::kernel, ground, surface), 0.8);
    }
}

TEST_P(RestingGap, In3DIsAsSmallAsIn2D) {
  const Condition condition = GetParam();
  const Obstacle ground =
      fixed(geometry::make_plane(Vec3(0, 0, 0.002), Vec3::UnitZ()), condition, 0.3);
  EXPECT_NEAR(resting_gap({3, Precision::float32}, 0.01, ContactRule::touch, ground, 0.002), 0,
              0.11);
}

/// Speed along z (m/s) of a small chunk that falls beside the edge of a plate.
double speed_beside_edge(ContactRule contact, double clearance) {
  Options o = touching_options({2, Precision::float64});
  o.settings.contact = contact;
  const auto solver = make_solver(
      o, {fixed(geometry::make_box(Vec3(-0.5, 0, -0.02), Vec3(1, 1, 0.04)), Condition::separate)});
  solver->add(filled_box(2, Vec3(clearance, 0, 0.01), Vec3(clearance + 0.02, 0, 0.02), 0.004));
  run_until(*solver, 0.06);
  return mean_velocity(*solver).z();
}

TEST(Touch, SnowPastAnEdgeIsNotCarried) {
  const double free_fall = -9.81 * 0.06;
  EXPECT_NEAR(speed_beside_edge(ContactRule::touch, 0.001), free_fall, 0.01);
  EXPECT_GT(speed_beside_edge(ContactRule::kernel, 0.001),
            0.8 * free_fall);  // the grid carries the snow
}

/// Snow that lies on the ground does not hold snow that falls a few cells away.
TEST(Touch, SnowBesideTouchingSnowFallsFreely) {
  const auto solver =
      make_solver(touching_options({2, Precision::float64}),
                  {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate)});
  solver->add(filled_box(2, Vec3(0.01, 0, -0.001), Vec3(0.03, 0, 0.019), 0.004));
  ParticleBatch falling = filled_box(2, Vec3(0.06, 0, 0.012), Vec3(0.08, 0, 0.024), 0.004);
  falling.event = 2;
  solver->add(falling);
  run_until(*solver, 0.03);
  const ParticleState s = solver->state();
  for (std::size_t i = 0; i < s.events.size(); ++i)
    if (s.events[i] == 2) EXPECT_NEAR(s.velocities[i].z(), -9.81 * solver->time(), 0.005);
}

/// The ball lies where the corners of four blocks meet.
TEST(Touch, ASmallBallBetweenBlocksHoldsSnow) {
  Options o = touching_options({2, Precision::float64});
  o.gravity = 0;
  const double corner = (8 + base_offset(Basis::quadratic)) * 0.01;
  const auto solver = make_solver(
      o, {fixed(geometry::make_sphere(Vec3(corner, 0, corner), 0.004), Condition::sticky)});
  ParticleBatch chunk = filled_box(2, Vec3(corner - 0.01, 0, corner + 0.01),
                                   Vec3(corner + 0.01, 0, corner + 0.03), 0.004);
  chunk.velocity.z() = -0.1;
  solver->add(chunk);
  run_until(*solver, 0.2);
  EXPECT_GT(mean_velocity(*solver).z(), -0.02);
}

TEST(Touch, FrictionFollowsCoulomb) {
  constexpr double tilt = radians(40);
  const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), slope(std::cos(tilt), 0, -std::sin(tilt));
  for (const Condition condition : {Condition::slip, Condition::separate})
    for (const double friction : {0.0, 0.3, 0.6}) {
      const auto solver =
          make_solver(touching_options({2, Precision::float32}),
                      {fixed(geometry::make_plane(Vec3::Zero(), normal), condition, friction)});
      ParticleBatch slab = filled_box(2, Vec3::Zero(), Vec3(0.25, 0, 0.03), 0.004);
      for (Vec3& x : slab.positions) x = x.x() * slope + x.z() * normal;
      solver->add(slab);
      run_until(*solver, 0.1);
      const double time = solver->time(), speed = mean_velocity(*solver).dot(slope);
      run_until(*solver, 0.3);
      const double by_coulomb = 9.81 * (std::sin(tilt) - friction * std::cos(tilt));
      EXPECT_NEAR((mean_velocity(*solver).dot(slope) - speed) / (solver->time() - time), by_coulomb,
                  0.02 * by_coulomb)
          << friction;
    }
}

/// Acceleration of a slab that starts at rest and covers a tilted plate from end to end, divided by
/// the acceleration with Coulomb's friction.
double acceleration_on_plate(double dx, double along, double thickness, Condition condition) {
  constexpr double tilt = radians(50), friction = 0.6, length = 0.245;
  const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), slope(std::cos(tilt), 0, -std::sin(tilt));
  Mat3 axes;
  axes << slope, Vec3::UnitY(), normal;
  const geometry::OrientedBox plate{(0.5 * length + along) * slope - 0.5 * thickness * normal, axes,
                                    Vec3(0.5 * length, 0.5, 0.5 * thickness)};
  const auto solver = make_solver(touching_options({2, Precision::float32}, dx),
                                  {fixed(geometry::make_box(plate), condition, friction)});
  ParticleBatch slab = filled_box(2, Vec3::Zero(), Vec3(length, 0, 0.02), dx / 2.5);
  for (Vec3& x : slab.positions) x = (x.x() + along) * slope + x.z() * normal;
  solver->add(slab);
  run_until(*solver, 0.06);
  const double time = solver->time(), speed = mean_velocity(*solver).dot(slope);
  run_until(*solver, 0.1);
  return (mean_velocity(*solver).dot(slope) - speed) / (solver->time() - time) / 9.81 /
         (std::sin(tilt) - friction * std::cos(tilt));
}

/// Nothing holds snow at the ends of a plate.
TEST(Touch, SnowStartsToSlideOffAPlateThatItCovers) {
  for (const double dx : {0.02, 0.01})
    for (const double along : {0.0, 0.3 * dx, 0.7 * dx})
      for (const double thickness : {0.5 * dx, 3 * dx})
        for (const Condition condition : {Condition::slip, Condition::separate})
          EXPECT_NEAR(acceleration_on_plate(dx, along, thickness, condition), 1, 0.06)
              << dx << " m, " << along << ", " << thickness << ", " << int(condition);
}

TEST(Touch, AMovingObstaclePushesOnceItTouches) {
  Options o = touching_options({2, Precision::float64});
  o.gravity = 0;
  Obstacle wall =
      fixed(geometry::make_box(Vec3(-0.05, 0, 0), Vec3(0.1, 1, 1)), Condition::separate);
  geometry::MotionSpec motion;
  motion.velocity = Vec3(0.5, 0, 0);
  wall.motion.emplace(motion);
  const auto solver = make_solver(o, {wall});
  solver->add(filled_box(2, Vec3(0.02, 0, 0), Vec3(0.06, 0, 0.04), 0.004));
  run_until(*solver,
            0.036);  // the wall has moved 1.8 cm, and its nodes have long reached the snow
  EXPECT_EQ(mean_velocity(*solver).norm(), 0.0);
  run_until(*solver, 0.08);
  EXPECT_GT(mean_velocity(*solver).x(), 0.45);
}

/// A particle at rest, and the contacts that it makes act.
class TouchOfAParticle {
 public:
  TouchOfAParticle(const Obstacle& obstacle, const Vec3& position)
      : model_(with_obstacle(obstacle)), state_(model_), touch_(Basis::quadratic) {
    ParticleBatch particle;
    particle.positions = {position};
    particle.mass = model_.options.snows[0].density * 0.004 * 0.004;
    std::vector<BlockKey> blocks;
    state_.append(model_, particle, blocks);
    state_.arrange(model_, blocks);
    touch_.forget(model_, state_);
    update(0.0);
  }

  void move_by_cells(double along_x) {
    state_.particles.cell[0][0] += along_x;
    update(along_x * dx);
  }
  void wait_until(double time) {
    state_.totals.time = time;
    state_.follow_obstacles(model_, 1);
    update(0.0);
  }

  /// The x (cells) of the nodes that act, in ascending order, each once.
  std::set<double> acting_nodes() {
    std::set<double> nodes;
    for (std::size_t g = 0; g < state_.layout.grid_blocks.size(); ++g)
      for (int c = 0; c < state_.contacts.count(g); ++c) {
        const Contact<double>& contact = state_.contacts.of_block(g)[c];
        const auto block = block_coord<2>(state_.layout.grid_blocks[g]);
        if (contact.acts) nodes.insert(std::round(node_position<2>(block, contact.node, 1.0)[0]));
      }
    return nodes;
  }

 private:
  static constexpr double dx = 0.01;
  static Options with_obstacle(const Obstacle& obstacle) {
    Options o = touching_options({2, Precision::float64}, dx);
    o.obstacles = {obstacle};
    return o;
  }
  void update(double moved) { touch_.update(model_, state_, moved, 1); }

  Model<double, 2> model_;
  State<double, 2> state_;
  Touch<double, 2> touch_;
};

TEST(Touch, TheNodesFollowTheSnow) {
  TouchOfAParticle snow(fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::slip),
                        Vec3(0.022, 0, 0.001));
  EXPECT_EQ(snow.acting_nodes(), (std::set<double>{1, 2, 3}));
  snow.move_by_cells(1.0);
  EXPECT_EQ(snow.acting_nodes(), (std::set<double>{2, 3, 4}));
}

TEST(Touch, AnObstacleComesToSnowAtRest) {
  Obstacle wall =
      fixed(geometry::make_box(Vec3(-0.05, 0, 0), Vec3(0.1, 1, 1)), Condition::separate);
  geometry::MotionSpec motion;
  motion.velocity = Vec3(0.5, 0, 0);
  wall.motion.emplace(motion);
  TouchOfAParticle snow(wall, Vec3(0.022, 0, 0.1));
  EXPECT_TRUE(snow.acting_nodes().empty());
  snow.wait_until(0.03);
  EXPECT_TRUE(snow.acting_nodes().empty());
  snow.wait_until(0.042);
  EXPECT_FALSE(snow.acting_nodes().empty());
}

template <int D>
void expect_radius_of_volume() {
  constexpr double spacing = 0.004, part = 0.8;
  Options o = touching_options({D, Precision::float64});
  o.settings.contact_radius = part;
  const Model<double, D> model(o);
  State<double, D> state(model);
  ParticleBatch particle;
  particle.positions = {Vec3::Zero()};
  particle.mass = o.snows[0].density * std::pow(spacing, D);
  std::vector<BlockKey> blocks;
  state.append(model, particle, blocks);
  const double initial = state.particles.plastic[0];
  for (const double ratio : {1.0, 0.5, 1.4, 4.0}) {  // dilation beyond 1.5 does not count
    state.particles.plastic[0] = initial + std::log(ratio);
    EXPECT_NEAR(state.contact_radius(model, 0),
                part * spacing / 2 * std::pow(std::min(ratio, 1.5), 1.0 / D), 1e-9)
        << D << ", " << ratio;
  }
}

TEST(Touch, TheContactRadiusFollowsFromTheVolume) {
  expect_radius_of_volume<2>();
  expect_radius_of_volume<3>();
}

class TouchCheckpoint : public io::TemporaryFolder {};

std::unique_ptr<Solver> landing_snow(int threads) {
  Options o = touching_options({2, Precision::float32});
  o.settings.threads = threads;
  o.settings.sleep_speed = 0.02;
  auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.5),
          fixed(geometry::make_box(Vec3(0, 0, 0.02), Vec3(0.05, 1, 0.04)), Condition::slip)});
  ParticleBatch below = filled_box(2, Vec3(-0.3, 0, 0.001), Vec3(-0.05, 0, 0.04), 0.004);
  ParticleBatch above = filled_box(2, Vec3(-0.1, 0, 0.06), Vec3(0.3, 0, 0.09), 0.004);
  above.velocity = Vec3(-0.5, 0, -1);
  solver->add(below);
  solver->add(above);
  return solver;
}

TEST_F(TouchCheckpoint, ThreadsAndResumingDoNotChangeTheBits) {
  const auto single = landing_snow(1), several = landing_snow(3);
  for (Solver* solver : {single.get(), several.get()}) {
    run_steps(*solver, 900);
    while (!solver->at_safe_point()) solver->step();
  }
  expect_same_bits(snow_state(*several), snow_state(*single));
  expect_resumes(*single, *landing_snow(1), path("state"), 300);
}

}  // namespace
}  // namespace snowshed::methods::mpm
