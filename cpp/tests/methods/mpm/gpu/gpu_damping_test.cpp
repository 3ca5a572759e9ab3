// Damping over a length of the solver on a device.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options damped_options(double length = dx) {
  Options o = options_on_gpu(dx);
  o.settings.transfer = Transfer::affine_flip;
  o.settings.damping_rate = 200;
  o.settings.damping_length = length;
  return o;
}

Obstacle rough_ground() {
  return fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.3);
}

ParticleBatch snow_to_damp() {
  ParticleBatch batch = filled_box(3, Vec3(-0.113, -0.021, 0.02), Vec3(0.087, 0.179, 0.17), dx / 2);
  batch.velocity = Vec3(2, 0, -4);
  return batch;
}

SnowState fall_and_damp(Solver& solver, double time) {
  solver.add(snow_to_damp());
  solver.advance(time);
  return snow_state(solver);
}

TEST(GpuDamping, AgreesWithTheProcessorOverAnyLength) {
  std::vector<SnowState> states;
  for (const double length : {0.3 * dx, dx, 2.7 * dx}) {
    SCOPED_TRACE(length);
    const auto cpu = make_solver(damped_options(length), {rough_ground()});
    const auto gpu = make_emulated(damped_options(length), {rough_ground()});
    const SnowState a = fall_and_damp(*cpu, 0.025), b = fall_and_damp(*gpu, 0.025);
    EXPECT_LT(largest_distance(a, b), 1e-5);
    EXPECT_NEAR(mean(a.pressures), mean(b.pressures), 1e-3 * std::abs(mean(a.pressures)) + 0.05);
    states.push_back(b);
  }
  for (const std::size_t other : {0u, 2u})
    EXPECT_GT(largest_distance(states[1], states[other]), 1e-4);
}

TEST(GpuDamping, CountsTheStepsOfACheckpoint) {
  const auto gpu = make_emulated(damped_options(), {rough_ground()});
  gpu->add(snow_to_damp());
  run_steps(*gpu, 30);  // two steps after a damping
  const std::string file = testing::TempDir() + "gpu_damping.snow";
  io::BinaryWriter out;
  gpu->save(out);
  out.save(file);
  const auto cpu = make_solver(damped_options(), {rough_ground()});
  const auto resumed = make_emulated(damped_options(), {rough_ground()});
  for (Solver* s : {cpu.get(), resumed.get()}) s->load(io::BinaryReader::load(file));
  for (Solver* s : {cpu.get(), gpu.get(), resumed.get()}) run_steps(*s, 3);
  EXPECT_LT(largest_distance(cpu->state(), gpu->state()), 1e-7);
  EXPECT_LT(largest_distance(resumed->state(), gpu->state()), 1e-7);
}

/// A stone that falls onto sleeping snow is damped towards its rest.
TEST(GpuDamping, SleepingSnowTakesPart) {
  Options o = damped_options(2 * dx);
  o.settings.sleep_speed = 2;
  o.settings.sleep_time = 0.01;
  const auto gpu = make_emulated(o, {rough_ground()});
  const auto cpu = make_solver(o, {rough_ground()});
  for (Solver* s : {gpu.get(), cpu.get()}) {
    s->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.213, 0.207, 0.187), dx / 2));
    s->advance(0.1);
    ParticleBatch stone = filled_box(3, Vec3(0.05, 0.05, 0.215), Vec3(0.15, 0.15, 0.315), dx / 2);
    stone.velocity = Vec3(0, 0, -4);
    s->add(stone);
    run_steps(*s, 24);
    EXPECT_GT(s->slept_updates(), 0);
  }
  EXPECT_LT(largest_distance(gpu->state(), cpu->state()), 1e-5);
}

/// Lone particles far outside the tile of their block are damped towards themselves.
TEST(GpuDamping, DoesNotSlowLoneParticles) {
  Options o = damped_options();
  o.gravity = 0;
  const auto solver = make_emulated(o, {});
  const std::vector<Vec3> velocities{{60, 0, 0}, {-60, 40, 0}, {0, -50, 50}};
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    ParticleBatch lone;
    lone.positions = {Vec3(2.0 * double(i), 0.013, 0.027)};
    lone.velocity = velocities[i];
    lone.mass = 0.01;
    solver->add(lone);
  }
  run_steps(*solver, 100);
  const ParticleState after = solver->state();
  for (std::size_t i = 0; i < velocities.size(); ++i)
    EXPECT_LT((after.velocities[i] - velocities[i]).norm(), 1e-4 * velocities[i].norm());
}

TEST(GpuDamping, HasTheSameBitsInWhateverOrderTheThreadsRun) {
  SnowState states[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver = make_emulated(damped_options(), {rough_ground()}, turns);
    states[turns == Turns::backwards] = fall_and_damp(*solver, 0.025);
  }
  expect_same_bits(states[0], states[1]);
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
