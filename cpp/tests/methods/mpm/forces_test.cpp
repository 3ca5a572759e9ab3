// The record of forces: weights, Coulomb's law, impulses, and the balance of momentum.
#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double gravity = 9.81;

Options recording(const SolverVariant& variant, double dx = 0.01) {
  Options o = options_for(variant, dx);
  o.forces = true;
  return o;
}

Obstacle named(const char* name, geometry::Shape shape, Condition condition, double friction = 0,
               const Vec3& velocity = Vec3::Zero()) {
  Obstacle o = fixed(std::move(shape), condition, friction);
  o.name = name;
  if (velocity.isZero()) return o;
  geometry::MotionSpec motion;
  motion.velocity = velocity;
  o.motion.emplace(motion);
  return o;
}

Obstacle ground(Condition condition, double friction = 0) {
  return named("ground", geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), condition, friction);
}

const ContactImpulse& resting(const RestingForces& forces, std::size_t name) {
  return forces.forces[name].force;
}

/// The names in the record are in the order of the obstacles.
TEST(Forces, RestingSlabWeighsOnGroundAndPlateOnAnyGrid) {
  for (const bool sleeps : {true, false})
    for (const double dx : {0.02, 0.01, 0.005}) {
      Options o = recording({2, Precision::float32}, dx);
      if (sleeps) o.settings.sleep_speed = 0.02;
      const auto solver =
          make_solver(o, {ground(Condition::separate, 0.4),
                          named("plate", geometry::make_box(Vec3(0.5, 0, 0.1), Vec3(0.3, 1, 0.2)),
                                Condition::separate, 0.4)});
      const ParticleBatch low = filled_box(2, Vec3(0, 0, 0), Vec3(0.2, 0, 0.1), dx / 2);
      const ParticleBatch high = filled_box(2, Vec3(0.4, 0, 0.2), Vec3(0.6, 0, 0.3), dx / 2);
      solver->add({low, high});
      run_until(*solver, 0.5);
      const RestingForces forces = solver->resting_forces(true);
      EXPECT_NEAR(resting(forces, 0).total().z() / (-gravity * low.total_mass()), 1, 1e-3) << dx;
      EXPECT_NEAR(resting(forces, 1).total().z() / (-gravity * high.total_mass()), 1, 1e-3) << dx;
      EXPECT_NEAR(resting(forces, 1).center().x(), 0.5, 0.2 * dx) << dx;
      EXPECT_EQ(solver->slept_updates() > 0, sleeps);
      // Without the completion at rest, the means alone are near the weight.
      const RestingForces means = solver->resting_forces(false);
      EXPECT_NEAR(resting(means, 1).total().z() / (-gravity * high.total_mass()), 1, 0.05) << dx;
    }
}

TEST(Forces, NormalAndTangentialPartsOfASlidingSlabFollowCoulomb) {
  for (const ContactRule rule : {ContactRule::kernel, ContactRule::touch})
    for (const double mu : {0.2, 0.4}) {
      constexpr double tilt = 40;
      const Vec3 normal(std::sin(radians(tilt)), 0, std::cos(radians(tilt)));
      Options o = recording({2, Precision::float64});
      o.settings.contact = rule;
      o.snows[0].model = material::SnowModel::elastic;
      const auto solver = make_solver(
          o, {named("slope", geometry::make_plane(Vec3::Zero(), normal), Condition::slip, mu)});
      const Vec3 along(normal.z(), 0, -normal.x());
      ParticleBatch slab = filled_box(2, Vec3(0, 0, 0), Vec3(0.2, 0, 0.05), 0.005);
      for (Vec3& x : slab.positions) x = x.x() * along + x.z() * normal;
      solver->add(slab);
      run_until(*solver, 0.1);
      const ContactImpulse begin = solver->sample_forces(0.1)[0].impulse;
      run_until(*solver, 0.5);
      const ContactImpulse force = 1 / 0.4 * (solver->sample_forces(0.4)[0].impulse - begin);
      EXPECT_NEAR(force.tangential.norm() / force.push / mu, 1, 0.005);
      EXPECT_NEAR(force.push / (slab.total_mass() * gravity * normal.z()), 1, 0.005);
      EXPECT_NEAR(force.normal.normalized().dot(-normal), 1, 1e-6);
      EXPECT_NEAR(force.tangential.normalized().dot(along), 1, 1e-3);
    }
}

TEST(Forces, DroppedBlockGivesItsMomentumAndItsWeight) {
  for (const Condition condition : {Condition::sticky, Condition::slip, Condition::separate}) {
    const auto solver = make_solver(recording({2, Precision::float64}), {ground(condition, 0.3)});
    ParticleBatch block = filled_box(2, Vec3(0, 0, 0.03), Vec3(0.08, 0, 0.08), 0.005);
    block.velocity = Vec3(0.5, 0, -2);
    solver->add(block);
    run_until(*solver, 0.4);
    const Vec3 after = momentum(solver->state()), before = block.total_mass() * block.velocity;
    const Vec3 impulse = solver->sample_forces(solver->time())[0].impulse.total();
    const Vec3 expected =
        before - after - Vec3(0, 0, block.total_mass() * gravity * solver->time());
    EXPECT_LT((impulse - expected).norm(), 1e-9 * expected.norm());
    EXPECT_LT(solver->forces()->unbalanced().norm(), 1e-9 * expected.norm());
    EXPECT_LT(impulse.z(), -1.5 * block.total_mass() * 2);
  }
}

/// The impulses of the obstacles and of gravity are the change of momentum, to rounding.
void expect_balance(const Solver& solver, double scale, double tolerance) {
  EXPECT_LT(solver.forces()->unbalanced().norm(), tolerance * scale);
}

TEST(Forces, BalanceOfMomentumClosesInRandomScenes) {
  Random random(5);
  for (const SolverVariant& variant : all_solver_variants()) {
    for (const Fields fields : {Fields::one, Fields::events}) {
      Options o = recording(variant, 0.02);
      o.settings.fields = fields;
      if (random.uniform() < 0.5) o.settings.contact = ContactRule::touch;
      if (variant.transfer == Transfer::affine_flip && random.uniform() < 0.5) {
        o.settings.damping_length = 0.01;
        o.settings.damping_rate = 380;
      }
      const Condition conditions[] = {Condition::sticky, Condition::slip, Condition::separate};
      const auto any = [&] { return conditions[int(2.999 * random.uniform())]; };
      const auto solver = make_solver(
          o,
          {ground(any(), random.uniform()),
           named("ball",
                 geometry::make_sphere(Vec3(0.1, 0, 0.06) + random_vector(random, 2, 0.05), 0.05),
                 any(), random.uniform()),
           named("ram", geometry::make_box(Vec3(-0.1, 0, 0.1), Vec3(0.06, 1, 0.2)), any(), 0.2,
                 Vec3(0.5, 0, 0))});
      const auto box = [&](const Vec3& low) {
        ParticleBatch batch =
            filled_box(variant.dimension, low, low + Vec3(0.14, 0.06, 0.08), 0.01);
        batch.velocity = random_vector(random, variant.dimension, 2.0);
        return batch;
      };
      solver->add(box(Vec3(0, 0, 0.13)));
      const double scale = total_mass(solver->state()) * 2;
      run_steps(*solver, 150);
      ParticleBatch second = box(Vec3(0, 0, 0.25));
      second.event = 2;
      solver->add(second);
      run_steps(*solver, 150);
      solver->add_velocity(
          std::vector<Vec3>(solver->size(), random_vector(random, variant.dimension, 1.0)));
      run_steps(*solver, 150);
      solver->replace({box(Vec3(0, 0, 0.12))});
      run_steps(*solver, 150);
      solver->sample_forces(1);
      expect_balance(*solver, scale, 3000 * variant.epsilon());
    }
  }
}

TEST(Forces, RejectedStepsDoNotCount) {
  const SolverVariant variant{2, Precision::float32};
  Options o = recording(variant);
  o.settings.strain_limit = 0.002;
  const auto solver = make_solver(o, {ground(Condition::sticky)});
  ParticleBatch block = filled_box(2, Vec3(0, 0, 0.02), Vec3(0.1, 0, 0.07), 0.005);
  block.velocity = Vec3(1, 0, -5);
  solver->add(block);
  run_steps(*solver, 200);
  ASSERT_GT(solver->counters().rejected, 10);
  solver->sample_forces(0.1);
  expect_balance(*solver, 5 * block.total_mass(), 3000 * variant.epsilon());
}

TEST(Forces, ContactsThatTheSnowHasLeftCount) {
  const SolverVariant variant{2, Precision::float64};
  const auto solver = make_solver(recording(variant), {ground(Condition::separate, 0.3)});
  ParticleBatch block = filled_box(2, Vec3(0, 0, 0), Vec3(0.1, 0, 0.05), 0.005);
  block.velocity = Vec3(20, 0, 0);
  solver->add(block);
  run_until(*solver, 0.1);
  solver->sample_forces(0.1);
  expect_balance(*solver, 20 * block.total_mass(), 3000 * variant.epsilon());
}

/// Sleeping snow keeps its contacts' mean forces; its obstacles receive what these lack, and that
/// is little.
TEST(Forces, SleepingSnowKeepsPressing) {
  Options o = recording({2, Precision::float32});
  o.settings.sleep_speed = 0.02;
  const auto solver = make_solver(o, {ground(Condition::sticky)});
  const ParticleBatch block = filled_box(2, Vec3(0, 0, 0), Vec3(0.3, 0, 0.1), 0.005);
  solver->add(block);
  run_until(*solver, 0.5);
  const double begin = solver->time();
  const ContactImpulse before = solver->sample_forces(begin)[0].impulse;
  ParticleBatch stone = filled_box(2, Vec3(0.6, 0, 0.5), Vec3(0.62, 0, 0.52), 0.005);
  solver->add(stone);
  run_until(*solver, begin + 0.2);
  const double duration = solver->time() - begin;
  const auto sample = solver->sample_forces(duration)[0];
  const ContactImpulse force = 1 / duration * (sample.impulse - before);
  EXPECT_NEAR(force.total().z() / (-gravity * block.total_mass()), 1, 1e-3);
  EXPECT_LT(solver->forces()->unbalanced().norm(), 1e-3 * block.total_mass() * gravity * duration);
  EXPECT_NEAR(sample.pressed.pressure / (210 * gravity * 0.1), 1, 0.4);  // without the balance
}

TEST(Forces, PressureAtRestComesFromTheWeight) {
  const auto solver = make_solver(recording({2, Precision::float32}), {ground(Condition::sticky)});
  solver->add(filled_box(2, Vec3(0, 0, 0), Vec3(0.5, 0, 0.1), 0.005));
  run_until(*solver, 0.5);
  const RestingForces forces = solver->resting_forces(true);
  const double expected = 210 * gravity * 0.1;
  EXPECT_NEAR(forces.forces[0].force.push / 0.5 / expected, 1, 1e-3);
  EXPECT_NEAR(forces.forces[0].pressed.pressure / expected, 1, 0.25);
  EXPECT_NEAR(forces.forces[0].pressed.area, 0.5, 0.11);
  EXPECT_NEAR(solver->forces()->pressures().edge(), 0.05, 1e-12);
}

TEST(Forces, ObstaclesWithOneNameCountAsOne) {
  Obstacle unnamed = ground(Condition::sticky);
  unnamed.name.clear();
  const auto solver = make_solver(recording({2, Precision::float32}),
                                  {ground(Condition::sticky), unnamed, ground(Condition::slip)});
  EXPECT_EQ(solver->forces()->names(), (std::vector<std::string>{"ground", "obstacle 2"}));
}

TEST(Forces, AreNotRecordedUnlessAskedFor) {
  const auto solver =
      make_solver(options_for({2, Precision::float32}), {ground(Condition::sticky)});
  EXPECT_EQ(solver->forces(), nullptr);
}

class StoredForces : public io::TemporaryFolder {};

TEST_F(StoredForces, ResumeToTheSameBits) {
  Options o = recording({2, Precision::float32});
  o.settings.sleep_speed = 0.02;
  const std::vector<Obstacle> obstacles = {
      ground(Condition::separate, 0.3),
      named("ram", geometry::make_box(Vec3(-0.1, 0, 0.1), Vec3(0.1, 1, 0.2)), Condition::slip, 0.2,
            Vec3(0.05, 0, 0))};
  const auto solver = make_solver(o, obstacles), fresh = make_solver(o, obstacles);
  solver->add(filled_box(2, Vec3(0, 0, 0.01), Vec3(0.3, 0, 0.1), 0.005));
  run_until(*solver, 0.2);
  while (!solver->at_safe_point()) solver->step();
  EXPECT_GT(solver->slept_updates(), 0);
  expect_resumes(*solver, *fresh, path("forces"), 400);
  const auto a = solver->sample_forces(1), b = fresh->sample_forces(1);
  for (const std::size_t i : {0, 1}) {
    EXPECT_EQ(a[i].impulse.total(), b[i].impulse.total());
    EXPECT_EQ(a[i].impulse.moment, b[i].impulse.moment);
    EXPECT_EQ(a[i].pressed.pressure, b[i].pressed.pressure);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(solver->forces()->forces()[i].means.peak(k),
                fresh->forces()->forces()[i].means.peak(k));
  }
  const auto &p = solver->forces()->pressures().patches(),
             &q = fresh->forces()->pressures().patches();
  ASSERT_EQ(p.size(), q.size());
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(p[i].peak, q[i].peak);
}

TEST_F(StoredForces, BeginAnewAfterARunWithoutThem) {
  const Options with = recording({2, Precision::float32});
  Options without = with;
  without.forces = false;
  const auto first = make_solver(without, {ground(Condition::sticky)});
  first->add(filled_box(2, Vec3(0, 0, 0), Vec3(0.2, 0, 0.1), 0.005));
  run_until(*first, 0.3);
  io::BinaryWriter out;
  first->save(out);
  out.save(path("state"));
  const auto second = make_solver(with, {ground(Condition::sticky)});
  second->load(io::BinaryReader::load(path("state")));
  run_until(*second, 0.5);
  const double weight = gravity * total_mass(second->state());
  EXPECT_NEAR(second->sample_forces(1)[0].impulse.total().z() / (-weight * 0.2), 1, 0.05);
  EXPECT_LT(second->forces()->unbalanced().norm(), 1e-4 * weight);
}

}  // namespace
}  // namespace snowshed::methods::mpm
