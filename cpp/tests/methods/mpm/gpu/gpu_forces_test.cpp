// The record of forces of the solver on a device: weights, and the processor's record.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options recording(double sleep_speed = 0) {
  Options o = options_on_gpu(dx);
  o.forces = true;
  o.settings.sleep_speed = sleep_speed;
  return o;
}

Obstacle named(const char* name, geometry::Shape shape, Condition condition, double friction) {
  Obstacle o = fixed(std::move(shape), condition, friction);
  o.name = name;
  return o;
}

Obstacle ground(Condition condition = Condition::separate) {
  return named("ground", geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), condition, 0.3);
}

/// Two obstacles that share blocks of nodes, beside those of the ground alone.
std::vector<Obstacle> ground_and_stone(Condition condition) {
  return {ground(condition), named("stone", geometry::make_sphere(Vec3(0.25, 0.1, 0.02), 0.12),
                                   Condition::separate, 0.5)};
}

ParticleBatch flying_block() {
  ParticleBatch block = filled_box(3, Vec3(0.05, 0, 0.13), Vec3(0.3, 0.2, 0.28), dx / 2);
  block.velocity = Vec3(2, 0, -4);
  return block;
}

void expect_close(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

/// Expects the same record of two solvers, up to a share of their largest values.
void expect_same_record(Solver& a, Solver& b, double share) {
  const auto p = a.sample_forces(a.time()), q = b.sample_forces(b.time());
  ASSERT_EQ(p.size(), q.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double scale = share * (p[i].impulse.total().norm() + 1e-3);
    expect_close(p[i].impulse.normal, q[i].impulse.normal, scale);
    expect_close(p[i].impulse.tangential, q[i].impulse.tangential, scale);
    expect_close(p[i].impulse.moment, q[i].impulse.moment, scale);
    EXPECT_NEAR(p[i].pressed.pressure, q[i].pressed.pressure, share * p[i].pressed.pressure);
    // A patch whose impulse is zero to rounding counts or does not.
    EXPECT_NEAR(p[i].pressed.area, q[i].pressed.area, 1.3 * std::pow(4 * dx, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& peak = a.forces()->forces()[i].means.peak(k);
      expect_close(peak, b.forces()->forces()[i].means.peak(k), share * (peak.norm() + 1e-3));
    }
  }
}

TEST(GpuForces, RestingSlabHasItsWeight) {
  for (const double sleep_speed : {0.0, 0.05}) {
    SCOPED_TRACE(sleep_speed);
    const auto solver = make_emulated(recording(sleep_speed), {ground()});
    const ParticleBatch slab = filled_box(3, Vec3(0, 0, 0.0), Vec3(0.1, 0.1, 0.05), dx / 2);
    solver->add(slab);
    solver->advance(0.25);
    EXPECT_EQ(solver->slept_updates() > 0, sleep_speed > 0);
    const double weight = 9.81 * slab.total_mass();
    EXPECT_NEAR(solver->resting_forces(true).forces[0].force.total().z() / -weight, 1, 1e-3);
    EXPECT_NEAR(solver->resting_forces(false).forces[0].force.total().z() / -weight, 1, 0.05);
    solver->sample_forces(0.25);
    EXPECT_LT(solver->forces()->unbalanced().norm(), 1e-4 * weight * 0.25);
  }
}

TEST(GpuForces, HasTheRecordOfTheProcessor) {
  for (const Condition condition : {Condition::sticky, Condition::slip, Condition::separate}) {
    SCOPED_TRACE(int(condition));
    const auto cpu = make_solver(recording(), ground_and_stone(condition));
    const auto gpu = make_emulated(recording(), ground_and_stone(condition));
    for (Solver* s : {cpu.get(), gpu.get()}) {
      s->begin_force_event();
      s->add(flying_block());
      s->advance(0.02);
      s->sample_forces(0.02);
      s->advance(0.045);
    }
    expect_same_record(*cpu, *gpu, 2e-3);
  }
}

/// A try of a step that was too long exerts no force: the recorded impulses are the change of the
/// snow's momentum.
TEST(GpuForces, RejectedStepsDoNotCount) {
  Options o = recording();
  o.settings.strain_limit = 0.01;
  const auto solver = make_emulated(o, ground_and_stone(Condition::slip));
  solver->add(flying_block());
  const Vec3 before = momentum(solver->state());
  run_steps(*solver, 80);
  EXPECT_GT(solver->counters().rejected, 10);
  const ParticleState after = solver->state();
  const Vec3 weight(0, 0, -9.81 * total_mass(after) * solver->time());
  const Vec3 from_obstacles = momentum(after) - before - weight;
  Vec3 recorded = Vec3::Zero();
  for (const ForceSample& sample : solver->sample_forces(solver->time()))
    recorded += sample.impulse.total();
  EXPECT_GT(from_obstacles.norm(), 0.1 * before.norm());
  expect_close(-recorded, from_obstacles, 1e-3 * from_obstacles.norm());
}

TEST(GpuForces, SleepingSnowStillPresses) {
  const auto cpu = make_solver(recording(0.2), ground_and_stone(Condition::separate));
  const auto gpu = make_emulated(recording(0.2), ground_and_stone(Condition::separate));
  for (Solver* s : {cpu.get(), gpu.get()}) {
    s->add(filled_box(3, Vec3(0, 0, 0.01), Vec3(0.4, 0.2, 0.11), dx / 2));
    s->advance(0.15);
    EXPECT_GT(s->slept_updates(), 0);
  }
  expect_same_record(*cpu, *gpu, 0.02);
}

TEST(GpuForces, FollowObstaclesInMotion) {
  const Obstacle lift =
      rising(named("lift", geometry::make_box(Vec3(0.25, 0.15, -0.15), Vec3(0.9, 0.7, 0.3)),
                   Condition::separate, 0.3));
  const auto cpu = make_solver(recording(), {lift});
  const auto gpu = make_emulated(recording(), {lift});
  for (Solver* s : {cpu.get(), gpu.get()}) {
    s->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.213, 0.207, 0.112), dx / 2));
    run_steps(*s, 40);
  }
  expect_same_record(*cpu, *gpu, 2e-3);
}

TEST(GpuForces, HaveTheSameBitsInWhateverOrderTheThreadsRun) {
  std::vector<ForceSample> samples[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver =
        make_emulated(recording(0.02), ground_and_stone(Condition::separate), turns);
    solver->add(flying_block());
    solver->advance(0.04);
    samples[turns == Turns::backwards] = solver->sample_forces(0.04);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(samples[0][i].impulse.moment == samples[1][i].impulse.moment);
    EXPECT_EQ(samples[0][i].pressed.pressure, samples[1][i].pressed.pressure);
  }
}

TEST(GpuForces, AgreeWithTheProcessorAfterACheckpoint) {
  const auto gpu = make_emulated(recording(), ground_and_stone(Condition::slip));
  gpu->add(flying_block());
  run_steps(*gpu, 60);
  const std::string file = testing::TempDir() + "gpu_forces.snow";
  io::BinaryWriter out;
  gpu->save(out);
  out.save(file);
  const auto cpu = make_solver(recording(), ground_and_stone(Condition::slip));
  cpu->load(io::BinaryReader::load(file));
  for (Solver* s : {cpu.get(), gpu.get()}) run_steps(*s, 40);
  expect_same_record(*cpu, *gpu, 2e-3);
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
