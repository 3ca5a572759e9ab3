#include "snowshed/methods/mpm/sleep.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double sleep_speed = 0.02;

const SolverVariant two_d{2, Precision::float32}, three_d{3, Precision::float32};

Options sleepy(const SolverVariant& variant, double speed = sleep_speed,
               bool energy_balance = false) {
  Options o = options_for(variant);
  o.snows[0].model = material::SnowModel::cam_clay;
  o.settings.sleep_speed = speed;
  o.energy = energy_balance;
  return o;
}

Obstacle floor() {
  return fixed(geometry::make_plane(Vec3(0, 0, 0), Vec3(0, 0, 1)), Condition::sticky);
}

/// A low wall of snow, resting on the floor.
ParticleBatch wall_of_snow(const SolverVariant& variant) {
  return filled_box(variant.dimension, Vec3(0, 0, 0), Vec3(0.3, 0.06, 0.08), 0.005);
}

/// A lump in free fall that lands on the middle of the wall after `time`.
ParticleBatch falling_lump(const SolverVariant& variant, double time) {
  const double low = 0.085 + 3 * time;
  ParticleBatch batch =
      filled_box(variant.dimension, Vec3(0.13, 0, low), Vec3(0.17, 0.06, low + 0.04), 0.005);
  batch.velocity = Vec3(0, 0, -3 + 9.81 * time / 2);
  return batch;
}

std::unique_ptr<Solver> wall_under_lump(const SolverVariant& variant, double speed, int threads = 1,
                                        bool energy_balance = false) {
  Options o = sleepy(variant, speed, energy_balance);
  o.settings.threads = threads;
  auto solver = make_solver(o, {floor()});
  solver->add(wall_of_snow(variant));
  solver->add(falling_lump(variant, 0.15));
  return solver;
}

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, (a[i] - b[i]).norm());
  return distance;
}

class SleepCheckpoint : public io::TemporaryFolder {};

TEST(Sleep, SnowAtRestCostsNothingAndDoesNotMove) {
  for (const SolverVariant& variant : {two_d, three_d}) {
    const auto solver = make_solver(sleepy(variant), {floor()});
    solver->add(wall_of_snow(variant));
    run_until(*solver, 0.2);
    const ParticleState before = solver->state();
    const StepCounters counters = solver->counters();
    const std::int64_t slept = solver->slept_updates();
    run_steps(*solver, 500);
    EXPECT_EQ(solver->counters().particle_updates, counters.particle_updates);
    EXPECT_EQ(solver->slept_updates() - slept, std::int64_t(500 * solver->size()));
    EXPECT_EQ(max_distance(solver->state().positions, before.positions), 0.0);
    EXPECT_EQ(solver->motion(sleep_speed).rms_speed, 0.0);
  }
}

TEST(Sleep, IsOffAtSpeedZero) {
  const auto solver = make_solver(sleepy(two_d, 0.0, true), {floor()});
  solver->add(wall_of_snow(two_d));
  run_until(*solver, 0.2);
  EXPECT_EQ(solver->slept_updates(), 0);
  EXPECT_EQ(energy_of(*solver).sleep, 0.0);
}

/// The snow takes a twentieth of a second to become faster than the limit. It must not fall asleep
/// in this time, because its mean velocity grows.
TEST(Sleep, SnowThatSetsOffSlowlyKeepsMoving) {
  Options o = sleepy(two_d);
  o.gravity = 0.4;
  const auto solver = make_solver(o, {});
  solver->add(wall_of_snow(two_d));
  const double start = weighted_mean(solver->state(), solver->state().positions)[2];
  run_until(*solver, 0.3);
  const double fallen = start - weighted_mean(solver->state(), solver->state().positions)[2];
  EXPECT_NEAR(fallen, 0.5 * o.gravity * solver->time() * solver->time(), 0.01 * fallen);
}

/// A slab on a ramp of 40 degrees whose friction nearly holds it: 0.3 and 0.07 m/s2 down the slope.
TEST(Sleep, ASlabThatSetsOffSlowlyKeepsMoving) {
  const double tilt = radians(40);
  const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), slope(std::cos(tilt), 0, -std::sin(tilt));
  for (const double friction : {0.8, 0.82, 0.83}) {
    double speed[2];
    for (const double limit : {0.0, sleep_speed}) {
      const auto solver = make_solver(
          sleepy(two_d, limit),
          {fixed(geometry::make_plane(Vec3::Zero(), normal), Condition::separate, friction)});
      ParticleBatch slab = filled_box(2, Vec3::Zero(), Vec3(1, 0, 0.05), 0.005);
      for (Vec3& x : slab.positions) x = x.x() * slope + x.z() * normal;
      solver->add(slab);
      run_until(*solver, 0.5);
      speed[limit > 0] = weighted_mean(solver->state(), solver->state().velocities).dot(slope);
    }
    EXPECT_GT(speed[0], 0.4 * 9.81 * (std::sin(tilt) - friction * std::cos(tilt))) << friction;
    EXPECT_NEAR(speed[1], speed[0], 0.02 * speed[0]) << friction;
  }
}

/// Snow that drifts without gravity has a constant speed, and nothing wakes it.
TEST(Sleep, BeginsAtTheGivenSpeedAfterTheGivenTime) {
  for (const double part : {0.9, 1.1}) {
    Options o = sleepy(two_d);
    o.gravity = 0;
    const auto solver = make_solver(o, {});
    ParticleBatch drifting = wall_of_snow(two_d);
    drifting.velocity.x() = part * sleep_speed;
    solver->add(drifting);
    run_until(*solver, 0.9 * o.settings.sleep_time);
    EXPECT_EQ(solver->slept_updates(), 0) << part;
    run_until(*solver, 4 * o.settings.sleep_time);
    EXPECT_EQ(solver->slept_updates() > 0, part < 1) << part;
  }
}

/// A layer that is laid on snow without impact hardly moves: its weight alone must wake the snow,
/// which then carries it.
TEST(Sleep, PressureWakesSnow) {
  double gain[2];
  for (const double limit : {0.0, sleep_speed}) {
    const auto solver = make_solver(sleepy(two_d, limit), {floor()});
    const double top = 0.085;  // where a block of particles ends
    const ParticleBatch below = filled_box(2, Vec3::Zero(), Vec3(0.3, 0, top), 0.005);
    solver->add(below);
    const auto pressure = [&](double from) {  // mean over the tenth of a second after `from`
      double sum = 0, count = 0;
      run_until(*solver, from);
      while (solver->time() < from + 0.1) {
        run_steps(*solver, 8);
        const std::vector<double> pressures = values_by_id(*solver, "pressure");
        for (std::size_t i = 0; i < below.positions.size(); ++i) sum += pressures[i], ++count;
      }
      return sum / count;
    };
    const double before = pressure(0.2);
    EXPECT_EQ(solver->slept_updates() > 0, limit > 0);
    solver->add(filled_box(2, Vec3(0, 0, top), Vec3(0.3, 0, top + 0.01), 0.005));
    gain[limit > 0] = pressure(0.4) - before;
  }
  EXPECT_GT(gain[0], 5);
  EXPECT_NEAR(gain[1], gain[0], 0.3 * gain[0]);
}

/// A grain that enters a block of sleeping snow without touching it keeps flying.
TEST(Sleep, ArrivingParticlesWakeSnow) {
  Options o = sleepy(two_d);
  o.gravity = 0;
  const auto solver = make_solver(o, {});
  solver->add(filled_box(2, Vec3(0.01, 0, 0.01), Vec3(0.03, 0, 0.08), 0.005));
  run_until(*solver, 0.1);
  EXPECT_GT(solver->slept_updates(), 0);
  ParticleBatch grain;
  grain.positions = {Vec3(0.065, 0, 0.02)};
  grain.velocity = Vec3(0, 0, 0.1);
  grain.mass = 0.005;
  solver->add(grain);
  const double start = solver->time();
  run_until(*solver, start + 0.1);
  EXPECT_NEAR(solver->state().positions.back().z(), 0.02 + 0.1 * (solver->time() - start), 1e-4);
}

TEST(Sleep, SnowAtTheTopOfAThrowStaysAwake) {
  // The speed is the same before and after the top of a throw. It can also stay the same when an
  // impact reduces one component of the velocity while gravity increases another.
  Options o = sleepy(two_d, 0.2);
  for (const Vec3& thrown : {Vec3(0, 0, 0.05), Vec3(0.1, 0, 0.05), Vec3(-0.15, 0, 0.02)}) {
    const auto solver = make_solver(o, {});
    ParticleBatch lump = filled_box(2, Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1), 0.005);
    lump.velocity = thrown;
    solver->add(lump);
    run_until(*solver, 0.05);
    EXPECT_EQ(solver->slept_updates(), 0);
  }
}

TEST(Sleep, AnImpactWakesSnow) {
  for (const SolverVariant& variant : {two_d, three_d}) {
    const auto sleeping = wall_under_lump(variant, sleep_speed),
               awake = wall_under_lump(variant, 0.0);
    run_until(*sleeping, 0.12);
    EXPECT_GT(sleeping->slept_updates(), sleeping->counters().particle_updates / 4);
    const ParticleState before = sleeping->state();
    const double end = variant.dimension == 2 ? 0.5 : 0.3;
    run_until(*sleeping, end);
    run_until(*awake, end);
    const auto a = sleeping->state().positions, b = awake->state().positions;
    EXPECT_GT(max_distance(before.positions, a), 0.01);
    // The mean height hardly differs, and no particle differs by more than two cells.
    EXPECT_NEAR(weighted_mean(sleeping->state(), a)[2], weighted_mean(awake->state(), b)[2], 5e-4);
    EXPECT_LT(max_distance(a, b), 0.02);
    EXPECT_LT(sleeping->counters().particle_updates, awake->counters().particle_updates * 3 / 4);
  }
}

TEST(Sleep, EnergyLostToSleepIsRecorded) {
  const auto solver = wall_under_lump(two_d, sleep_speed, 1, true);
  run_until(*solver, 0.5);
  const EnergyBalance e = energy_of(*solver);
  EXPECT_GT(e.sleep, 0.0);
  EXPECT_LT(e.sleep, 0.01 * e.added);
  EXPECT_NEAR(e.residual(), 0.0, 0.01 * e.added);
}

TEST(Sleep, AMovingObstacleWakesSnow) {
  Obstacle paddle =
      fixed(geometry::make_box(Vec3(-0.05, 0, 0.05), Vec3(0.06, 1, 0.08)), Condition::sticky);
  geometry::MotionSpec motion;
  motion.start = 0.2;
  motion.velocity = Vec3(0.5, 0, 0);
  paddle.motion.emplace(motion);
  const auto solver = make_solver(sleepy(two_d), {floor(), paddle});
  solver->add(wall_of_snow(two_d));
  run_until(*solver, 0.2);
  EXPECT_EQ(solver->motion(sleep_speed).rms_speed, 0.0);
  run_until(*solver, 0.35);
  EXPECT_GT(solver->motion(sleep_speed).rms_speed, 0.05);
}

TEST(Sleep, AKickWakesSnow) {
  const auto solver = make_solver(sleepy(two_d), {floor()});
  solver->add(wall_of_snow(two_d));
  run_until(*solver, 0.2);
  solver->add_velocity(std::vector<Vec3>(solver->size(), Vec3(0.2, 0, 0)));
  const std::int64_t before = solver->counters().particle_updates;
  solver->step();
  EXPECT_EQ(solver->counters().particle_updates - before, std::int64_t(solver->size()));
}

TEST(Sleep, ThreadsDoNotChangeTheBits) {
  const auto single = wall_under_lump(three_d, sleep_speed),
             two = wall_under_lump(three_d, sleep_speed, 2);
  for (const auto* solver : {&single, &two}) run_until(**solver, 0.2);
  EXPECT_GT(single->slept_updates(), 0);
  EXPECT_EQ(two->slept_updates(), single->slept_updates());
  expect_same_bits(snow_state(*two), snow_state(*single));
}

TEST_F(SleepCheckpoint, ResumesToTheSameBits) {
  const auto reference = wall_under_lump(two_d, sleep_speed, 1, true);
  run_until(*reference, 0.1);
  EXPECT_GT(reference->slept_updates(), 0);
  while (!reference->at_safe_point()) reference->step();
  io::BinaryWriter out;
  reference->save(out);
  out.save(path("checkpoint"));
  const auto resumed = make_solver(sleepy(two_d, sleep_speed, true), {floor()});
  resumed->load(io::BinaryReader::load(path("checkpoint")));
  for (const auto* solver : {&reference, &resumed}) run_until(**solver, 0.25);
  expect_same_bits(snow_state(*resumed), snow_state(*reference));
  EXPECT_EQ(resumed->slept_updates(), reference->slept_updates());
  EXPECT_EQ(energy_of(*resumed).residual(), energy_of(*reference).residual());
}

/// The cells of the particles in sleeping blocks, as stored in a checkpoint.
std::vector<float> sleeping_cells(const io::BinaryReader& in) {
  const auto first = in.get<std::int32_t>("blocks/first");
  const auto sleep = in.get<double>("sleep");
  const std::size_t blocks = first.size() - 1, values = sleep.size() / blocks;
  std::vector<float> cells;
  for (const char* axis : {"particles/cell0", "particles/cell1"}) {
    const auto cell = in.get<float>(axis);
    for (std::size_t b = 0; b < blocks; ++b)
      if (sleep[b * values] != 0)
        cells.insert(cells.end(), cell.begin() + first[b], cell.begin() + first[b + 1]);
  }
  return cells;
}

/// Snow that drifts without gravity is quiet, and some of it is always about to leave its block.
TEST_F(SleepCheckpoint, SleepingSnowLiesWithinItsBlock) {
  for (const double speed : {0.5, 0.8, 1.1, 1.4}) {
    Options o = sleepy(two_d, 2.0);
    o.gravity = 0;
    o.settings.sleep_time = 0.005;
    const auto solver = make_solver(o, {});
    ParticleBatch glider = wall_of_snow(two_d);
    glider.velocity.x() = speed;
    solver->add(glider);
    std::size_t asleep = 0;
    for (int k = 0; k < 40; ++k) {
      run_steps(*solver, 8);
      io::BinaryWriter out;
      solver->save(out);
      out.save(path("checkpoint"));
      for (const float cell : sleeping_cells(io::BinaryReader::load(path("checkpoint")))) {
        ASSERT_GE(cell, 0.0f) << speed;
        ASSERT_LT(cell, 8.0f) << speed;
        ++asleep;
      }
    }
    EXPECT_GT(asleep, 1000u);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
