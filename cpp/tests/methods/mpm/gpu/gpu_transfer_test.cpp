// Transfers with an affine velocity and the regularised law of the solver on a device.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options affine_options(Transfer transfer = Transfer::affine_flip) {
  Options o = options_on_gpu(dx);
  o.settings.transfer = transfer;
  return o;
}

/// A slope and a ball, onto which snow falls and breaks.
std::vector<Obstacle> slope_and_ball() {
  return {fixed(geometry::make_plane(Vec3::Zero(), Vec3(-0.5, 0.1, 1.0).normalized()),
                Condition::separate, 0.3),
          fixed(geometry::make_sphere(Vec3(0.25, 0.1, 0.0), 0.15), Condition::separate, 0.5)};
}

ParticleBatch falling_snow() {
  const Vec3 low(0.013, -0.021, 0.12);
  ParticleBatch batch = filled_box(3, low, low + Vec3::Constant(4 * dx), dx / 2);
  batch.velocity = Vec3(3, 0, -5);
  return batch;
}

SnowState fall(Solver& solver, int steps = 80) {
  solver.add(falling_snow());
  run_steps(solver, steps);
  return snow_state(solver);
}

void expect_agreement(const Options& o) {
  const auto cpu = make_solver(o, slope_and_ball());
  const auto gpu = make_emulated(o, slope_and_ball());
  const SnowState a = fall(*cpu), b = fall(*gpu);
  EXPECT_LT(largest_distance(a, b), 2e-5);
  EXPECT_NEAR(mean(a.plastic_strains), mean(b.plastic_strains),
              1e-3 * std::abs(mean(a.plastic_strains)));
  EXPECT_NEAR(cpu->time(), gpu->time(), 1e-6 * cpu->time());
}

TEST(GpuTransfer, AgreesWithTheProcessor) {
  for (const Transfer transfer : {Transfer::apic, Transfer::affine_flip}) {
    SCOPED_TRACE(name_of(transfer));
    expect_agreement(affine_options(transfer));
  }
}

TEST(GpuTransfer, AgreesWithTheProcessorWithSeveralSnows) {
  Options o = affine_options();
  o.settings.damping_rate = 200;
  o.snows.emplace_back().youngs_modulus *= 3;
  expect_agreement(o);
}

/// APIC keeps the angular momentum of a block that turns in free flight, FLIP's share does not.
TEST(GpuTransfer, KeepsTheAngularMomentum) {
  Options o = affine_options(Transfer::apic);
  o.gravity = 0;
  o.snows.front().model = material::SnowModel::elastic;
  const auto solver = make_emulated(o, {});
  const ParticleBatch block =
      filled_box(3, Vec3::Constant(-2 * dx), Vec3::Constant(2 * dx), dx / 2);
  const Vec3 rate(3, -1, 2);  // s^-1
  std::vector<Vec3> velocities;
  for (const Vec3& x : block.positions) velocities.push_back(rate.cross(x));
  solver->add(block);
  solver->add_velocity(velocities);
  run_steps(*solver, 2);  // the nodes give the particles their affine velocity
  const auto angular_momentum = [&] {
    const ParticleState s = solver->state();
    const std::vector<double> affine = values_by_id(*solver, "affine");
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < s.positions.size(); ++i) {
      const double* c = affine.data() + 9 * i;
      const Vec3 curl(c[7] - c[5], c[2] - c[6], c[3] - c[1]);
      sum += s.masses[i] * (s.positions[i].cross(s.velocities[i]) + dx * dx / 4 * curl);
    }
    return sum;
  };
  const Vec3 before = angular_momentum();
  run_steps(*solver, 60);
  EXPECT_LT((angular_momentum() - before).norm(), 1e-5 * before.norm());
}

TEST(GpuTransfer, HasTheSameBitsInWhateverOrderTheThreadsRun) {
  SnowState states[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver = make_emulated(affine_options(), slope_and_ball(), turns);
    states[turns == Turns::backwards] = fall(*solver, 70);  // with a sort
  }
  expect_same_bits(states[0], states[1]);
}

TEST(GpuTransfer, ResumesToTheSameBits) {
  Options o = affine_options();
  o.settings.sleep_speed = 2;
  o.settings.sleep_time = 0.01;
  const auto ground = fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky);
  const auto solver = make_emulated(o, {ground});
  solver->add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.213, 0.207, 0.112), dx / 2));
  ParticleBatch beside = falling_snow();
  for (Vec3& x : beside.positions) x[0] += 1;
  solver->add(beside);
  solver->advance(0.06);
  EXPECT_GT(solver->slept_updates(), 0);
  while (!solver->at_safe_point()) solver->step();
  const auto fresh = make_emulated(o, {ground});
  expect_resumes(*solver, *fresh, testing::TempDir() + "gpu_affine.snow", 30);
}

TEST(GpuLaw, IsRegularisedAsOnTheProcessor) {
  for (const Transfer transfer : {Transfer::flip, Transfer::affine_flip}) {
    SCOPED_TRACE(name_of(transfer));
    Options o = affine_options(transfer);
    const SnowState plain = fall(*make_emulated(o, slope_and_ball()));
    o.settings.crack_band_length = dx / 5;
    expect_agreement(o);
    const SnowState banded = fall(*make_emulated(o, slope_and_ball()));
    EXPECT_GT(largest_distance(plain, banded), 1e-3);
    o.settings.crack_band_length = 0;
    o.settings.relaxation_time = 2e-3;
    expect_agreement(o);
    const SnowState relaxed = fall(*make_emulated(o, slope_and_ball()));
    EXPECT_GT(largest_distance(plain, relaxed), 1e-3);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
