// Sleep, checkpoints and moving obstacles of the solver on a device.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

std::vector<Obstacle> sticky_ground() {
  return {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)};
}

Options sleepy_options() {
  Options o = options_on_gpu(dx);
  o.settings.sleep_speed = 0.02;
  o.settings.sleep_time = 0.01;
  return o;
}

ParticleBatch slab() {
  return filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.413, 0.207, 0.112), dx / 2);
}

ParticleBatch stone(const Vec3& low, const Vec3& velocity) {
  ParticleBatch batch = filled_box(3, low, low + Vec3::Constant(0.1), dx / 2);
  batch.velocity = velocity;
  return batch;
}

TEST(GpuSleep, SnowFallsAsleepAndWakesWhenItIsHit) {
  const auto solver = make_emulated(sleepy_options(), sticky_ground());
  solver->add(slab());
  solver->advance(0.3);
  EXPECT_GT(solver->slept_updates(), 0);
  const ParticleState asleep = solver->state();
  solver->advance(0.31);
  EXPECT_EQ(largest_distance(asleep, solver->state()), 0.0);
  const std::int64_t before = solver->counters().particle_updates;
  solver->add(stone(Vec3(0.05, 0.05, 0.13), Vec3(0, 0, -5)));
  solver->advance(0.32);
  EXPECT_GT(solver->counters().particle_updates - before, 0);
  const ParticleState after = solver->state();
  double moved = 0;  // by the old snow, m
  for (std::size_t i = 0; i < asleep.positions.size(); ++i)
    moved = std::max(moved, (after.positions[i] - asleep.positions[i]).norm());
  EXPECT_GT(moved, 1e-4);
}

/// A stone falls onto a slab in other blocks, which sleeps on and shares only its mass and its
/// stresses.
TEST(GpuSleep, SleepingSnowActsOnAwakeSnowAsOnTheProcessor) {
  Options o = sleepy_options();
  o.settings.sleep_speed = 2;
  const auto gpu = make_emulated(o, sticky_ground());
  const auto cpu = make_solver(o, sticky_ground());
  std::int64_t awake[2];
  for (Solver* s : {gpu.get(), cpu.get()}) {
    s->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.213, 0.207, 0.187), dx / 2));
    s->advance(0.1);
    s->add(stone(Vec3(0.05, 0.05, 0.215), Vec3(0, 0, -4)));
    const std::int64_t before = s->counters().particle_updates;
    run_steps(*s, 24);
    awake[s == cpu.get()] = s->counters().particle_updates - before;
  }
  EXPECT_EQ(awake[1], 24 * 64);  // the stone alone
  EXPECT_EQ(awake[0], awake[1]);
  EXPECT_LT(largest_distance(gpu->state(), cpu->state()), 1e-5);
}

TEST(GpuSleep, DecidesAsTheProcessor) {
  const auto gpu = make_emulated(sleepy_options(), sticky_ground());
  const auto cpu = make_solver(sleepy_options(), sticky_ground());
  for (Solver* s : {gpu.get(), cpu.get()}) {
    s->add(slab());
    s->add(stone(Vec3(0.6, 0, 0.3), Vec3(0, 0, -2)));
    s->advance(0.2);
  }
  EXPECT_GT(cpu->slept_updates(), 0);
  EXPECT_NEAR(double(gpu->slept_updates()), double(cpu->slept_updates()),
              0.1 * double(cpu->slept_updates()));
}

/// A checkpoint of one device continues on the other.
TEST(GpuCheckpoint, ContinuesOnTheOtherDevice) {
  const Options o = options_on_gpu(dx);
  const auto obstacles = sticky_ground();
  const auto gpu = make_emulated(o, obstacles);
  gpu->add(slab());
  gpu->add(stone(Vec3(0.05, 0.05, 0.2), Vec3(1, 0, -3)));
  run_steps(*gpu, 40);
  const std::string file = testing::TempDir() + "gpu_checkpoint.snow";
  {
    io::BinaryWriter out;
    gpu->save(out);
    out.save(file);
  }
  const auto cpu = make_solver(o, obstacles);
  const auto resumed = make_emulated(o, obstacles);
  cpu->load(io::BinaryReader::load(file));
  resumed->load(io::BinaryReader::load(file));
  for (Solver* s : {gpu.get(), cpu.get(), resumed.get()}) run_steps(*s, 40);
  EXPECT_LT(largest_distance(gpu->state(), cpu->state()), 1e-6);
  EXPECT_LT(largest_distance(gpu->state(), resumed->state()), 1e-6);
}

TEST(GpuCheckpoint, ResumesToTheSameBitsFromASafePoint) {
  const Options o = sleepy_options();
  const auto solver = make_emulated(o, sticky_ground());
  solver->add(slab());
  do solver->step();
  while (!solver->at_safe_point());
  const auto fresh = make_emulated(o, sticky_ground());
  expect_resumes(*solver, *fresh, testing::TempDir() + "gpu_safe_point.snow", 30);
}

TEST(GpuObstacle, MovesTheSnowAsTheProcessorDoes) {
  const Obstacle lift = rising(fixed(
      geometry::make_box(Vec3(0.25, 0.15, -0.15), Vec3(0.9, 0.7, 0.3)), Condition::separate, 0.3));
  const Options o = sleepy_options();
  const auto gpu = make_emulated(o, {lift});
  const auto cpu = make_solver(o, {lift});
  for (Solver* s : {gpu.get(), cpu.get()}) {
    s->add(slab());
    run_steps(*s, 60);
  }
  EXPECT_LT(largest_distance(gpu->state(), cpu->state()), 1e-5);
  EXPECT_GT(mean_velocity(*gpu)[2], 0.2);
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
