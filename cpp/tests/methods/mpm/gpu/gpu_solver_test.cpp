#include "snowshed/methods/mpm/gpu_solver.hpp"

#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

geometry::Shape level_ground() { return geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()); }

/// A block of snow whose lower corner is at a height, m, in no special place on the grid.
ParticleBatch block_of_snow(double height, const Vec3& velocity = Vec3::Zero(), int cells = 4) {
  const Vec3 low(0.013, -0.021, height), size = Vec3::Constant(cells * dx);
  ParticleBatch batch = filled_box(3, low, low + size, dx / 2);
  batch.velocity = velocity;
  return batch;
}

struct BothSolvers {
  std::unique_ptr<Solver> cpu, gpu;
  void add(const ParticleBatch& batch) {
    cpu->add(batch);
    gpu->add(batch);
  }
  void run(int steps) {
    run_steps(*cpu, steps);
    run_steps(*gpu, steps);
  }
};

BothSolvers make_both(const Options& o, const std::vector<Obstacle>& obstacles = {}) {
  return {make_solver(o, obstacles), make_emulated(o, obstacles)};
}

void expect_close(const Solver& a, const Solver& b, double length, double share) {
  const SnowState x = snow_state(a), y = snow_state(b);
  ASSERT_EQ(x.ids, y.ids);
  EXPECT_LT(largest_distance(x, y), length);
  EXPECT_NEAR(mean(x.plastic_strains), mean(y.plastic_strains),
              share * std::abs(mean(x.plastic_strains)) + 1e-9);
  EXPECT_NEAR(mean(x.pressures), mean(y.pressures), share * std::abs(mean(x.pressures)) + 0.05);
  EXPECT_NEAR(a.time(), b.time(), 1e-6 * a.time());
}

TEST(GpuSolver, FallsFreelyAsTheFormulaSays) {
  const auto solver = make_emulated(options_on_gpu(dx), {});
  solver->add(block_of_snow(1.0, Vec3(3, -1, 2)));
  const SnowState before = snow_state(*solver);
  run_steps(*solver, 100);
  const SnowState after = snow_state(*solver);
  const double t = solver->time();
  for (std::size_t i = 0; i < after.positions.size(); ++i) {
    const Vec3 moved = after.positions[i] - before.positions[i];
    // Symplectic Euler falls by half a step more than the parabola.
    const double fall = 0.5 * 9.81 * t * t;
    EXPECT_NEAR(moved[0], 3 * t, 2e-6);
    EXPECT_NEAR(moved[1], -t, 2e-6);
    EXPECT_NEAR(moved[2], 2 * t - fall - 0.5 * 9.81 * t * solver->time_step(), 4e-6);
    EXPECT_NEAR(after.velocities[i][2], 2 - 9.81 * t, 2e-5);
    EXPECT_NEAR(after.volume_ratios[i], 1.0, 2e-6);
  }
}

TEST(GpuSolver, AgreesWithTheProcessorAtRest) {
  BothSolvers both = make_both(options_on_gpu(dx), {fixed(level_ground(), Condition::sticky)});
  both.add(block_of_snow(0.01));
  both.run(100);
  expect_close(*both.cpu, *both.gpu, 2e-7, 1e-5);
  EXPECT_EQ(both.cpu->counters().particle_updates, both.gpu->counters().particle_updates);
}

TEST(GpuSolver, AgreesWithTheProcessorInPlasticFlow) {
  BothSolvers both = make_both(options_on_gpu(dx), {fixed(level_ground(), Condition::sticky)});
  both.add(block_of_snow(0.02, Vec3(5, 0, -5)));
  both.run(100);
  EXPECT_LT(mean(snow_state(*both.cpu).plastic_strains), -1e-3);  // it flows
  expect_close(*both.cpu, *both.gpu, 1e-5, 1e-4);
}

TEST(GpuSolver, AgreesWithTheProcessorOnEachKindOfObstacle) {
  for (const Condition condition : {Condition::sticky, Condition::slip, Condition::separate}) {
    SCOPED_TRACE(int(condition));
    const geometry::Shape slope =
        geometry::make_plane(Vec3::Zero(), Vec3(-0.5, 0.1, 1.0).normalized());
    const geometry::Shape ball = geometry::make_sphere(Vec3(0.25, 0.1, 0.0), 0.15);
    BothSolvers both =
        make_both(options_on_gpu(dx), {fixed(slope, condition, 0.3), fixed(ball, condition, 0.5)});
    both.add(block_of_snow(0.12, Vec3(1, 0, -2)));
    both.run(80);
    expect_close(*both.cpu, *both.gpu, 1e-5, 1e-3);
  }
}

TEST(GpuSolver, AgreesWithTheProcessorWithSeveralSnows) {
  Options o = options_on_gpu(dx);
  material::Snow stiff;
  stiff.youngs_modulus *= 3;
  stiff.density = 350;
  material::Snow elastic;
  elastic.model = material::SnowModel::elastic;
  o.snows = {material::Snow(), stiff, elastic};
  BothSolvers both = make_both(o, {fixed(level_ground(), Condition::separate, 0.2)});
  for (int snow = 0; snow < 3; ++snow) {
    const Vec3 low(0.2 * snow, 0, 0.01);
    ParticleBatch batch =
        filled_box(3, low, low + Vec3(0.2, 0.1, 0.1), dx / 2, o.snows[std::size_t(snow)].density);
    batch.material_id = snow;
    batch.velocity = Vec3(0, 0, -3);
    both.add(batch);
  }
  both.run(80);
  expect_close(*both.cpu, *both.gpu, 1e-5, 1e-3);
}

/// Snow that fast movement strains beyond the limit needs repeated node steps.
TEST(GpuSolver, ShortensStepsAsTheProcessorDoes) {
  Options o = options_on_gpu(dx);
  o.settings.strain_limit = 0.01;
  BothSolvers both = make_both(o, {fixed(level_ground(), Condition::slip, 0.4)});
  both.add(block_of_snow(0.005, Vec3(5, 0, -8)));
  both.run(40);
  EXPECT_GT(both.cpu->counters().rejected, 0);
  EXPECT_EQ(both.cpu->counters().rejected, both.gpu->counters().rejected);
  expect_close(*both.cpu, *both.gpu, 1e-5, 1e-3);
}

TEST(GpuSolver, DampsByARateAsTheProcessorDoes) {
  Options o = options_on_gpu(dx);
  o.settings.damping_rate = 200;
  BothSolvers both = make_both(o, {fixed(level_ground(), Condition::sticky)});
  both.add(block_of_snow(0.01, Vec3(0, 0, -1)));
  both.run(60);
  expect_close(*both.cpu, *both.gpu, 1e-6, 1e-4);
}

TEST(GpuSolver, HasTheSameBitsInWhateverOrderTheThreadsRun) {
  SnowState states[2];
  using snowshed::gpu::Turns;
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver = make_emulated(
        options_on_gpu(dx),
        {fixed(level_ground(), Condition::slip, 0.4),
         fixed(geometry::make_sphere(Vec3(0.1, 0.1, 0.0), 0.12), Condition::separate, 0.2)},
        turns);
    solver->add(block_of_snow(0.1, Vec3(4, 1, -6)));
    run_steps(*solver, 70);  // with a sort
    states[turns == Turns::backwards] = snow_state(*solver);
  }
  expect_same_bits(states[0], states[1]);
}

/// A lone particle flies through many blocks; between sorts it is far outside the tile of its own.
TEST(GpuSolver, KeepsParticlesThatLeaveTheTileOfTheirBlock) {
  Options o = options_on_gpu(dx);
  o.gravity = 0;
  const auto device = emulated_card();
  const auto solver = make_gpu_solver(o, device);
  const std::vector<Vec3> velocities{{60, 0, 0}, {-60, 40, 0}, {0, -50, 50}, {30, 30, -60}};
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    ParticleBatch lone;
    lone.positions = {Vec3(double(i), 0.013, 0.027)};
    lone.velocity = velocities[i];
    lone.mass = 0.01;
    solver->add(lone);
  }
  const ParticleState before = solver->state();
  run_steps(*solver, 200);
  const ParticleState after = solver->state();
  double travel = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const Vec3 moved = after.positions[i] - before.positions[i];
    EXPECT_NEAR((moved - velocities[i] * solver->time()).norm(), 0, 1e-4 * moved.norm());
    travel = std::max(travel, moved.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(travel, 8 * dx);
  EXPECT_LT(solver->sorts(), 200 / 3);  // it was not sorted all the time
}

TEST(GpuSolver, SlidesOnAnInclineAsTheFormulaSays) {
  constexpr double friction = 0.3, slope = 35;
  const double angle = radians(slope);
  Options o = options_on_gpu(dx);
  const Vec3 normal(-std::sin(angle), 0, std::cos(angle));
  const Vec3 downhill(-std::cos(angle), 0, -std::sin(angle));
  const geometry::Shape incline = geometry::make_plane(Vec3::Zero(), normal);
  const auto solver = make_emulated(o, {fixed(incline, Condition::separate, friction)});
  ParticleBatch block = filled_box(3, Vec3(0, 0, 0), Vec3(0.3, 0.2, 0.15), dx / 2);
  for (Vec3& x : block.positions)
    x = x[0] * -downhill + x[1] * Vec3::UnitY() + (x[2] + 0.5 * dx) * normal;
  solver->add(block);
  const double settled = 0.05, end = 0.15;
  solver->advance(settled);
  const double begin_time = solver->time();
  const Vec3 before = mean_velocity(*solver);
  solver->advance(end);
  const double acceleration =
      (mean_velocity(*solver) - before).dot(downhill) / (solver->time() - begin_time);
  const double formula = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_NEAR(acceleration, formula, 0.1 * formula);
}

TEST(GpuSolver, ConservesMomentumWithoutForces) {
  Options o = options_on_gpu(dx);
  o.gravity = 0;
  const auto solver = make_emulated(o, {});
  ParticleBatch left = block_of_snow(0.0, Vec3(4, 0.5, -0.25), 2);
  ParticleBatch right = block_of_snow(0.02, Vec3(-3, 0, 1), 2);
  for (Vec3& x : right.positions) x[0] += 2.2 * dx;
  solver->add(left);
  solver->add(right);
  const SnowState start = snow_state(*solver);
  const Vec3 before = momentum(start);
  run_steps(*solver, 80);
  const SnowState after = snow_state(*solver);
  EXPECT_GT(std::abs(mean(after.plastic_strains) - mean(start.plastic_strains)), 1e-3);  // collided
  EXPECT_NEAR((momentum(after) - before).norm() / total_mass(after), 0, 3e-6);
}

TEST(GpuSolver, AdvancesToATimeInManySteps) {
  const auto solver = make_emulated(options_on_gpu(dx), {});
  solver->add(block_of_snow(1.0));
  solver->advance(0.01);
  EXPECT_GE(solver->time(), 0.01);
  EXPECT_LT(solver->time() - solver->time_step(), 0.01);
  const double time = solver->time();
  solver->advance(0.005);
  EXPECT_EQ(solver->time(), time);
}

TEST(GpuSolver, SnowMayBeEditedBetweenSteps) {
  BothSolvers both = make_both(options_on_gpu(dx), {fixed(level_ground(), Condition::sticky)});
  both.add(block_of_snow(0.01));
  both.run(20);
  both.add(block_of_snow(0.26, Vec3(0, 0, -2)));
  both.run(20);
  const std::vector<Vec3> push(both.cpu->size(), Vec3(1, 0, 0));
  both.cpu->add_velocity(push);
  both.gpu->add_velocity(push);
  both.run(20);
  const std::vector<double> drops(both.cpu->size(), 0.001), plastic(both.cpu->size(), -0.01);
  both.cpu->settle(drops, plastic);
  both.gpu->settle(drops, plastic);
  both.run(20);
  expect_close(*both.cpu, *both.gpu, 1e-5, 1e-3);
}

/// As reseeding between events does: other particles in the place of those that came to rest.
TEST(GpuSolver, SnowMayBeReplacedBetweenEvents) {
  Options o = options_on_gpu(dx);
  o.forces = true;
  o.settings.transfer = Transfer::affine_flip;
  o.settings.damping_rate = 200;
  o.settings.damping_length = dx;
  BothSolvers both = make_both(o, {fixed(level_ground(), Condition::separate, 0.3)});
  both.add(block_of_snow(0.01, Vec3(1, 0, -2)));
  both.run(30);
  ParticleBatch old_snow = filled_box(3, Vec3(0, 0, 0.01), Vec3(0.25, 0.2, 0.16), dx / 3);
  ParticleBatch new_snow = block_of_snow(0.2, Vec3(0, 0, -3));
  new_snow.event = 1;
  for (Solver* s : {both.cpu.get(), both.gpu.get()}) {
    s->replace({old_snow});
    s->begin_force_event();
    s->add(new_snow);
  }
  both.run(40);
  expect_close(*both.cpu, *both.gpu, 1e-5, 1e-3);
  const Vec3 force = both.cpu->forces()->forces()[0].means.peak(1);
  EXPECT_LT((force - both.gpu->forces()->forces()[0].means.peak(1)).norm(), 2e-3 * force.norm());
}

TEST(GpuSolver, SaysThatATimeStepFellToZero) {
  Options o = options_on_gpu(dx);
  o.settings.strain_limit = 1e-12;
  const auto solver = make_emulated(o, {fixed(level_ground(), Condition::sticky)});
  solver->add(block_of_snow(0.005, Vec3(0, 0, -8)));
  const ParticleState before = solver->state();
  try {
    solver->step();
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("the time step fell to"), std::string::npos);
  }
  EXPECT_EQ(solver->time(), 0);
  EXPECT_TRUE(solver->state().positions == before.positions);
}

TEST(GpuSolver, FailsForSnowThatIsTooSoft) {
  Options o = options_on_gpu(dx);
  o.snows.front().youngs_modulus = 10;
  o.snows.front().model = material::SnowModel::elastic;
  const auto solver = make_emulated(o, {fixed(level_ground(), Condition::sticky)});
  solver->add(block_of_snow(0.005, Vec3(0, 0, -30)));
  EXPECT_THROW(run_steps(*solver, 3000), SimulationError);
  try {
    solver->step();
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("elastic strain"), std::string::npos) << error.what();
  }
}

TEST(GpuSolver, GivesItsMemoryBack) {
  const auto device = emulated_card();
  {
    Options o = options_on_gpu(dx);
    const auto solver = make_gpu_solver(o, device);
    solver->add(block_of_snow(0.1));
    run_steps(*solver, 3);
    EXPECT_GT(device->bytes_in_use(), 0u);
  }
  EXPECT_EQ(device->bytes_in_use(), 0u);
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
