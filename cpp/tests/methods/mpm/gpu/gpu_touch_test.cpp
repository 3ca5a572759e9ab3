// Contact by touch of the solver on a device, whose host measures the distances.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options touching_options() {
  Options o = options_on_gpu(dx);
  o.settings.contact = ContactRule::touch;
  return o;
}

/// A slope, and a thin plate above it.
std::vector<Obstacle> slope_and_plate() {
  return {fixed(geometry::make_plane(Vec3::Zero(), Vec3(-0.5, 0.1, 1.0).normalized()),
                Condition::separate, 0.3),
          fixed(geometry::make_box(Vec3(0.25, 0.1, 0.17), Vec3(0.3, 0.3, 0.02)),
                Condition::separate, 0.4)};
}

/// Takes the steps to a time (s) at once, so that the card must wait for the host.
SnowState fall_onto_plate(Solver& solver, double time) {
  ParticleBatch block = filled_box(3, Vec3(0.05, 0, 0.22), Vec3(0.25, 0.2, 0.37), dx / 2);
  block.velocity = Vec3(2, 0, -3);
  solver.add(block);
  solver.advance(time);
  return snow_state(solver);
}

TEST(GpuTouch, AgreesWithTheProcessor) {
  const auto cpu = make_solver(touching_options(), slope_and_plate());
  const auto gpu = make_emulated(touching_options(), slope_and_plate());
  const SnowState a = fall_onto_plate(*cpu, 0.035), b = fall_onto_plate(*gpu, 0.035);
  EXPECT_LT(largest_distance(a, b), 1e-4);
  Options kernel = touching_options();
  kernel.settings.contact = ContactRule::kernel;
  const SnowState other = fall_onto_plate(*make_emulated(kernel, slope_and_plate()), 0.035);
  EXPECT_GT(largest_distance(b, other), 2e-3);
}

/// The host looks only where and when snow may have moved far enough to touch.
TEST(GpuTouch, HostLooksRarelyAtSnowThatRests) {
  Options o = touching_options();
  o.settings.sleep_speed = 0.05;
  o.obstacles = {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate)};
  const auto device = emulated_card();
  const auto solver = make_gpu_solver(o, device);
  solver->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.113, 0.107, 0.062), dx / 2));
  solver->advance(0.15);
  const auto launches = [&] { return device->launches().at("permute2"); };
  const int before = launches();
  const std::int64_t sorts = solver->sorts();
  run_steps(*solver, 100);
  EXPECT_LT(launches() - before, 10 + 2 * (solver->sorts() - sorts));
}

TEST(GpuTouch, FollowsObstaclesInMotion) {
  const Obstacle lift = rising(fixed(
      geometry::make_box(Vec3(0.15, 0.1, -0.15), Vec3(0.9, 0.7, 0.3)), Condition::separate, 0.3));
  const auto cpu = make_solver(touching_options(), {lift});
  const auto gpu = make_emulated(touching_options(), {lift});
  for (Solver* s : {cpu.get(), gpu.get()}) {
    s->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.163, 0.157, 0.112), dx / 2));
    run_steps(*s, 40);
  }
  EXPECT_LT(largest_distance(cpu->state(), gpu->state()), 1e-5);
}

/// Reading the snow between steps does not change it.
TEST(GpuTouch, HasTheSameBitsInWhateverOrderTheThreadsRun) {
  SnowState states[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver = make_emulated(touching_options(), slope_and_plate(), turns);
    fall_onto_plate(*solver, 0.01);
    if (turns == Turns::backwards) solver->state();
    solver->advance(0.025);
    states[turns == Turns::backwards] = snow_state(*solver);
  }
  expect_same_bits(states[0], states[1]);
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
