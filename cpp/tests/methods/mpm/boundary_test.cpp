#include "snowshed/methods/mpm/boundary.hpp"

#include <gtest/gtest.h>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/combine.hpp"

namespace snowshed::methods::mpm {
namespace {

// --- Coulomb friction -------------------------------------------------------------------------

constexpr double tilt = radians(40);
const Vec3 ramp_normal(std::sin(tilt), 0, std::cos(tilt)),
    ramp_slope(std::cos(tilt), 0, -std::sin(tilt));

struct Slide {
  double length, friction;
  Condition condition = Condition::separate;
  Transfer transfer = Transfer::flip;
};

/// A slab, 5 cm thick, released on a ramp of 40 degrees.
std::unique_ptr<Solver> slab_on_ramp(const Slide& slide) {
  const Options o = options_for({2, Precision::float32, slide.transfer});
  auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), ramp_normal), slide.condition, slide.friction)});
  ParticleBatch batch = filled_box(2, Vec3::Zero(), Vec3(slide.length, 0, 0.05), 0.005);
  for (Vec3& x : batch.positions) x = x.x() * ramp_slope + x.z() * ramp_normal;
  solver->add(batch);
  return solver;
}

double mean_speed(const Method& solver) { return mean_velocity(solver).dot(ramp_slope); }

/// Mean acceleration down the slope between two times.
double acceleration(const Slide& slide, double from, double to) {
  const auto solver = slab_on_ramp(slide);
  run_until(*solver, from);
  const double time = solver->time(), speed = mean_speed(*solver);
  run_until(*solver, to);
  return (mean_speed(*solver) - speed) / (solver->time() - time);
}

double by_coulomb(double friction) { return 9.81 * (std::sin(tilt) - friction * std::cos(tilt)); }

// The usual nodal rule fails on this slab: it holds the slab at mu = 0.6 (tan 40 = 0.84).
class LongSlab : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Friction, LongSlab, testing::Values(0.0, 0.3, 0.6, 0.8));

TEST_P(LongSlab, FollowsCoulombWithSeparate) {
  const double friction = GetParam();
  EXPECT_NEAR(acceleration({2.0, friction}, 0.1, 0.5), by_coulomb(friction),
              0.01 * by_coulomb(friction));
}

// With slip an obstacle also holds snow against pulls. The pulls must reduce the friction; with the
// usual rule they do not.
TEST_P(LongSlab, FollowsCoulombWithSlip) {
  const double friction = GetParam();
  EXPECT_NEAR(acceleration({2.0, friction, Condition::slip}, 0.1, 0.3), by_coulomb(friction),
              0.02 * by_coulomb(friction));
}

TEST(Friction, ShortSlabsFollowCoulombAlsoWithSlipAndApic) {
  for (const Slide& slide :
       {Slide{0.25, 0.6, Condition::slip}, Slide{0.25, 0.3, Condition::separate},
        Slide{0.25, 0.6, Condition::separate, Transfer::apic}})
    EXPECT_NEAR(acceleration(slide, 0.1, 0.4), by_coulomb(slide.friction),
                0.01 * by_coulomb(slide.friction));
}

TEST(Friction, HoldsSlabsBelowTheAngleOfFriction) {
  for (Condition condition : {Condition::slip, Condition::separate})
    for (double friction : {0.9, 1.2}) {
      const auto solver = slab_on_ramp({0.25, friction, condition});
      const ParticleState start = solver->state();
      run_until(*solver, 0.15);
      EXPECT_NEAR(mean_speed(*solver), 0.0, 1e-3) << friction;
      const ParticleState end = solver->state();
      EXPECT_LT((weighted_mean(end, end.positions) - weighted_mean(start, start.positions)).norm(),
                1e-3)
          << friction;
    }
}

TEST(Friction, StopsASlidingSlab) {
  // On level ground the slab stops within the time v/(mu g) and the distance v^2/(2 mu g), once
  // contact has set in.
  const auto solver = make_solver(
      options_for({2, Precision::float32}),
      {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.5)});
  ParticleBatch batch = filled_box(2, Vec3::Zero(), Vec3(0.2, 0, 0.03), 0.005);
  batch.velocity.x() = 1;
  solver->add(batch);
  run_until(*solver, 0.05);
  const ParticleState start = solver->state();
  const double speed = weighted_mean(start, start.velocities).x();
  const double stopping_time = speed / (0.5 * 9.81), begin = solver->time();
  run_until(*solver, begin + 0.9 * stopping_time);
  EXPECT_GT(mean_velocity(*solver).x(), 0.05 * speed);
  run_until(*solver, begin + 1.1 * stopping_time);
  EXPECT_NEAR(mean_velocity(*solver).x(), 0.0, 1e-3 * speed);
  const ParticleState end = solver->state();
  EXPECT_NEAR(weighted_mean(end, end.positions).x() - weighted_mean(start, start.positions).x(),
              speed * stopping_time / 2, 0.01 * speed * stopping_time / 2);
}

struct Chunk {
  double cells, speed, tilt, friction;  // edge; m/s; degrees
};

/// Expects Coulomb's friction and its energy for a chunk of snow, at most five cells high, that
/// slides down a ramp. Friction sets in after half a cell of sliding. This delay matters most for a
/// chunk of two cells, because it covers a node only while it slides four cells.
void expect_coulomb(const Chunk& c, double tolerance) {
  SCOPED_TRACE(testing::Message() << c.cells << " cells, " << c.speed << " m/s, " << c.tilt);
  constexpr double dx = 0.01;
  const double a = radians(c.tilt);
  const Vec3 normal(std::sin(a), 0, std::cos(a)), slope(std::cos(a), 0, -std::sin(a));
  Options o = options_for({2, Precision::float32}, dx);
  o.energy = true;
  const auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), normal), Condition::separate, c.friction)});
  ParticleBatch chunk =
      filled_box(2, Vec3::Zero(), Vec3(c.cells, 0, std::min(c.cells, 5.0)) * dx, dx / 2);
  for (Vec3& x : chunk.positions) x = x.x() * slope + x.z() * normal;
  chunk.velocity = c.speed * slope;
  solver->add(chunk);
  run_until(*solver, 0.02);  // contact sets in
  struct Sample {
    double time, position, speed, friction_energy;
  };
  const auto sample = [&] {
    const ParticleState s = solver->state();
    return Sample{solver->time(), weighted_mean(s, s.positions).dot(slope),
                  weighted_mean(s, s.velocities).dot(slope), energy_of(*solver).friction};
  };
  const Sample from = sample();
  run_until(*solver, 0.12);
  const Sample to = sample();
  const double friction = c.friction * 9.81 * std::cos(a);  // m/s2
  const double measured_friction =
      9.81 * std::sin(a) - (to.speed - from.speed) / (to.time - from.time);
  EXPECT_NEAR(measured_friction, friction, tolerance * friction);
  const double work = total_mass(solver->state()) * friction * (to.position - from.position);
  EXPECT_NEAR(to.friction_energy - from.friction_energy, work, tolerance * work);
}

TEST(Friction, FastChunksFollowCoulomb) {
  for (const double speed : {5.0, 10.0, 15.0})
    for (const double cells : {2.0, 4.0, 8.0}) {
      expect_coulomb({cells, speed, 40, 0.3}, 0.03);
      expect_coulomb({cells, speed, 0, 0.8}, 0.03);
    }
}

TEST(Friction, FastSlabsFollowCoulomb) {
  for (const double speed : {5.0, 10.0, 15.0}) {
    expect_coulomb({30, speed, 40, 0.3}, 0.01);
    expect_coulomb({30, speed, 0, 0.8}, 0.01);
  }
}

// --- thin obstacles ---------------------------------------------------------------------------

TEST(ThickenedForGrid, PadsOnlyThinBodies) {
  const geometry::Shape thick = geometry::make_box(Vec3::Zero(), Vec3(1, 1, 0.02));
  EXPECT_EQ(thickened_for_grid(thick, 0.01, 3).shape, thick);
  const geometry::Shape thin = geometry::make_plate(Vec3::Zero(), Vec3::UnitZ(), 1, 1, 0.002);
  const geometry::Shape padded = thickened_for_grid(thin, 0.01, 3).shape;
  EXPECT_NEAR(padded->inradius(), 0.01, 1e-12);
  EXPECT_NEAR(padded->distance(Vec3(0, 0, 0.009)), 0.0, 1e-12);
  EXPECT_NEAR(padded->distance(Vec3(0, 0, -0.011)), 0.0, 1e-12);
  EXPECT_EQ(thickened_for_grid(padded, 0.01, 3).shape, padded);
}

struct Throw {
  int dimension;
  Precision precision;
  double turn;  // turn of the panel, degrees
};

TEST(ThinPanel, StopsAllSnow) {
  for (const Throw& t : {Throw{2, Precision::float32, 0}, Throw{2, Precision::float64, 30},
                         Throw{3, Precision::float32, 20}})
    for (Condition condition : {Condition::slip, Condition::separate, Condition::sticky}) {
      if (t.dimension == 3 && condition != Condition::separate) continue;
      const double a = radians(t.turn);
      const Vec3 normal(std::sin(a), 0, std::cos(a)), along(std::cos(a), 0, -std::sin(a));
      const auto solver =
          make_solver(options_for({t.dimension, t.precision}),
                      {fixed(geometry::make_plate(Vec3(0.0031, 0, 0.0017), normal, 2,
                                                  t.dimension == 2 ? geometry::infinity : 2, 0.002),
                             condition, 0.3)});
      const double size = t.dimension == 2 ? 0.1 : 0.05;
      ParticleBatch batch =
          filled_box(t.dimension, Vec3(0, 0, 0.06), Vec3(size, size, 0.06 + size), 0.005);
      batch.velocity.z() = -5;
      solver->add(batch);
      run_until(*solver, t.dimension == 2 ? 0.15 : 0.05);
      int below = 0;
      for (const Vec3& x : solver->state().positions)
        below += std::abs(along.dot(x)) < 0.9 && normal.dot(x) < -0.002;
      EXPECT_EQ(below, 0) << t.dimension << "D " << t.turn << " degrees";
    }
}

TEST(ThinPanel, SnowThrownAtTheUndersideFallsOff) {
  for (double degrees : {0.0, 40.0}) {
    const double a = radians(degrees);
    const Vec3 normal(std::sin(a), 0, std::cos(a));
    const auto solver =
        make_solver(options_for({2, Precision::float32}),
                    {fixed(geometry::make_plate(Vec3::Zero(), normal, 2,
                                                std::numeric_limits<double>::infinity(), 0.002),
                           Condition::separate, 0.6)});
    ParticleBatch batch = filled_box(2, Vec3(-0.05, 0, -0.15), Vec3(0.05, 0, -0.05), 0.005);
    batch.velocity.z() = 3;
    solver->add(batch);
    double reached = -1;
    while (solver->time() < 0.5) {
      run_steps(*solver, 100);
      for (const Vec3& x : solver->state().positions) reached = std::max(reached, normal.dot(x));
    }
    EXPECT_GT(reached, -0.03);  // the snow did hit the panel
    for (const Vec3& x : solver->state().positions) ASSERT_LT(x.dot(normal), -0.1) << degrees;
  }
}

// The inradius of a combined solid says nothing about its walls, which may be as thin as a plate.
TEST(ThinPanel, ThinWallsOfCombinedSolidsStopAllSnow) {
  const double wall = 0.003;
  const geometry::Shape bin = geometry::subtract(
      geometry::make_box(Vec3(0, 0, 0.1), Vec3(0.3, 10, 0.2)),
      {geometry::make_box(Vec3(0, 0, 0.1 + wall), Vec3(0.3 - 2 * wall, 11, 0.2))});
  const geometry::Shape shelf =
      geometry::unite({geometry::make_box(Vec3(0.1, 0, 0), Vec3(0.1, 10, 0.4)),
                       geometry::make_box(Vec3(-0.05, 0, 0.0017), Vec3(0.3, 10, wall))});
  for (const geometry::Shape& shape : {bin, shelf}) {
    const auto solver =
        make_solver(options_for({2, Precision::float32}), {fixed(shape, Condition::separate, 0.3)});
    ParticleBatch batch = filled_box(2, Vec3(-0.115, 0, 0.04), Vec3(-0.085, 0, 0.14), 0.005);
    batch.velocity.z() = -3;
    solver->add(batch);
    run_until(*solver, 0.15);
    // Some snow slides off the end of the shelf, which thickening has rounded and moved out by a
    // cell.
    for (const Vec3& x : solver->state().positions)
      if (x.x() > -0.21) ASSERT_GT(x.z(), 0);
  }
}

// --- bodies -----------------------------------------------------------------------------------

TEST(Contact, SnowSinksLessThanACellIntoBodies) {
  const geometry::Shape shapes[] = {
      geometry::make_sphere(Vec3::Zero(), 0.06),
      geometry::make_box(Vec3::Zero(), Vec3(0.1, 0.1, 0.06)),
      geometry::make_capsule(Vec3(-0.05, 0, -0.02), Vec3(0.05, 0, 0.02), 0.03)};
  for (const geometry::Shape& shape : shapes)
    for (Condition condition : {Condition::slip, Condition::separate, Condition::sticky}) {
      const auto solver =
          make_solver(options_for({2, Precision::float32}), {fixed(shape, condition, 0.2)});
      ParticleBatch batch = filled_box(2, Vec3(-0.04, 0, 0.08), Vec3(0.06, 0, 0.14), 0.005);
      batch.velocity.z() = -3;
      solver->add(batch);
      double deepest = 0;
      while (solver->time() < 0.08) {
        run_steps(*solver, 50);
        for (const Vec3& x : solver->state().positions)
          deepest = std::min(deepest, shape->distance(x));
      }
      EXPECT_GT(deepest, -0.01);
    }
}

TEST(Contact, AMovingPlateCarriesSnowAlong) {
  geometry::MotionSpec motion;
  motion.velocity = Vec3(0.3, 0, 0.5);
  Obstacle plate = fixed(geometry::make_plate(Vec3::Zero(), Vec3::UnitZ(), 1,
                                              std::numeric_limits<double>::infinity(), 0.05),
                         Condition::sticky);
  plate.motion.emplace(motion);
  const auto solver = make_solver(options_for({2, Precision::float32}), {plate});
  solver->add(filled_box(2, Vec3(0, 0, 0.003), Vec3(0.08, 0, 0.033), 0.005));
  const ParticleState start = solver->state();
  run_until(*solver, 0.2);
  const ParticleState end = solver->state();
  const Vec3 displacement =
      weighted_mean(end, end.positions) - weighted_mean(start, start.positions);
  EXPECT_LT((displacement - solver->time() * motion.velocity).norm(), 0.002);  // a fifth of a cell
  // The snow rattles over the cells.
  EXPECT_LT((mean_velocity(*solver) - motion.velocity).norm(), 0.05);
}

TEST(Contact, TheUndersideOfASeparatingObstacleReleasesAtOnce) {
  const Boundary<double, 2> boundary(
      {fixed(geometry::make_box(Vec3(0.035, 0, 0.035), Vec3(0.04, 1e9, 0.04)), Condition::separate,
             0.3)},
      0.01);
  auto contacts = Contacts<double, 2>().relocated(boundary, {block_key<2>({0, 0})}, 0.0);
  ASSERT_EQ(contacts.count(0), 16);  // nodes 2 to 5 in each direction
  for (int i = 0; i < 16; ++i) {
    const Contact<double>& c = contacts.of_block(0)[i];
    EXPECT_NEAR(std::hypot(c.normal[0], c.normal[1]), 1.0, 1e-12);
    EXPECT_EQ(c.release, c.normal[1] > 0 ? Release::after_push : Release::at_once);
  }
}

TEST(Contact, StoredImpulsesSurviveRelocation) {
  const Boundary<float, 2> boundary(
      {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.3)}, 0.01);
  const std::vector<BlockKey> few{block_key<2>({0, -1}), block_key<2>({0, 0})};
  auto contacts = Contacts<float, 2>().relocated(boundary, few, 0.0);
  ASSERT_EQ(contacts.count(0), 64);
  ASSERT_EQ(contacts.count(1), 8);
  contacts.of_block(1)[3].next_normal_impulse = 2.5f;
  contacts.commit(1);
  const auto stored = contacts.stored_impulses();
  ASSERT_EQ(stored.size(), 1u);
  EXPECT_EQ(stored[0].block, few[1]);
  EXPECT_EQ(stored[0].amount, 2.5);

  std::vector<BlockKey> more{block_key<2>({-1, 0}), few[0], few[1]};
  contacts = contacts.relocated(boundary, more, 0.0);
  EXPECT_EQ(contacts.of_block(2)[3].normal_impulse, 2.5f);

  contacts.of_block(2)[4].next_normal_impulse = -0.5f;  // negative, as with slip
  contacts.commit(2);
  EXPECT_EQ(contacts.stored_impulses().size(), 2u);

  auto fresh = Contacts<float, 2>().relocated(boundary, more, 0.0);
  EXPECT_TRUE(fresh.stored_impulses().empty());
  fresh.restore(stored);
  EXPECT_EQ(fresh.of_block(2)[3].normal_impulse, 2.5f);
}

}  // namespace
}  // namespace snowshed::methods::mpm
