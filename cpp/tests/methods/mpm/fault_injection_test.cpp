// Failed calls of the solver. Each allocation of a run with all features fails once. The failed
// call must leave the state unchanged, and the run must end with the same bits.
#include <sys/resource.h>

#include <csignal>

#include "io/temporary_folder.hpp"
#include "methods/call_sequence.hpp"
#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double dx = 0.02;

/// The state and the counters of a solver, as its caller sees them.
struct Observation {
  SnowState particles;
  double time;
  StepCounters counters;
  std::int64_t sorts, slept_updates;
  EnergyBalance energy;

  explicit Observation(const Solver& solver)
      : particles(snow_state(solver)),
        time(solver.time()),
        counters(solver.counters()),
        sorts(solver.sorts()),
        slept_updates(solver.slept_updates()),
        energy(energy_of(solver)) {}
};

void expect_same_counters(const StepCounters& a, const StepCounters& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.particle_updates, b.particle_updates);
  EXPECT_EQ(a.smallest_dt, b.smallest_dt);
}

/// Positions may have been rounded, because the sort of a failed step is kept.
void expect_same(const Observation& now, const Observation& before) {
  ASSERT_EQ(now.particles.ids, before.particles.ids);
  for (std::size_t i = 0; i < before.particles.ids.size(); ++i)
    ASSERT_LT((now.particles.positions[i] - before.particles.positions[i]).norm(), 1e-6 * dx);
  EXPECT_TRUE(now.particles.velocities == before.particles.velocities);
  EXPECT_EQ(now.particles.plastic_strains, before.particles.plastic_strains);
  EXPECT_EQ(now.particles.pressures, before.particles.pressures);
  EXPECT_EQ(now.time, before.time);
  expect_same_counters(now.counters, before.counters);
  EXPECT_EQ(now.sorts, before.sorts);
  EXPECT_EQ(now.slept_updates, before.slept_updates);
  EXPECT_EQ(now.energy.added, before.energy.added);
  EXPECT_EQ(now.energy.kinetic, before.energy.kinetic);
  EXPECT_EQ(now.energy.friction, before.energy.friction);
  EXPECT_EQ(now.energy.sleep, before.energy.sleep);
}

struct Case {
  int threads;
  double spacing;  // spacing of the particles, m
  int steps;       // before the impact; snow falls asleep if there are many
  bool moving;     // whether an obstacle moves, which takes memory in each step
};

std::unique_ptr<Solver> rough_floor(const Case& c) {
  Options o = options_for({2, Precision::float32}, dx);
  o.snows[0].youngs_modulus = 1e5;
  o.settings.threads = c.threads;
  o.settings.sleep_speed = 0.1;
  o.settings.sleep_time = 0.005;
  o.energy = true;
  std::vector<Obstacle> obstacles{
      fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.4)};
  if (c.moving) {
    Obstacle paddle =
        fixed(geometry::make_box(Vec3(-0.1, 0, 0.05), Vec3(0.0, 1, 0.08)), Condition::sticky);
    geometry::MotionSpec motion;
    motion.velocity = Vec3(0.5, 0, 0);
    paddle.motion.emplace(motion);
    obstacles.push_back(paddle);
  }
  return make_solver(o, std::move(obstacles));
}

/// Snow that lies on a rough floor, is hit by more, settles, is kicked, replaced and restored.
struct SnowCalls : CallSequence<Solver> {
  SnowCalls(const Case& c, std::filesystem::path file)
      : CallSequence(rough_floor(c), std::move(file)) {
    const ParticleBatch wall = filled_box(2, Vec3(0, 0, 0), Vec3(0.24, 0, 0.08), c.spacing);
    ParticleBatch lump = filled_box(2, Vec3(0.3, 0, 0.005), Vec3(0.4, 0, 0.05), c.spacing);
    lump.velocity = Vec3(-3, 0, -1);
    call([=](Solver& m) { m.add({wall}); });
    take_steps(c.steps);
    call([=](Solver& m) { m.add({lump, lump_above(lump)}); });
    take_steps(10);
    save();
    call([](Solver& m) {
      m.settle(std::vector<double>(m.size(), 1e-3), std::vector<double>(m.size(), -0.01));
    });
    take_steps(3);
    call([](Solver& m) { m.add_velocity(std::vector<Vec3>(m.size(), Vec3(-0.2, 0, 0))); });
    take_steps(3);
    call([=](Solver& m) { m.replace({lump, wall}); });
    take_steps(3);
    load();
    take_steps(10);
  }

 private:
  static ParticleBatch lump_above(ParticleBatch lump) {
    for (Vec3& x : lump.positions) x.z() += 0.06;
    return lump;
  }
};

class MpmFaultInjection : public io::TemporaryFolder {
 protected:
  /// Makes each allocation of each call fail once. Returns the number of failures.
  int try_all(const Case& c);
};

int MpmFaultInjection::try_all(const Case& c) {
  SnowCalls reference(c, path("reference")), faulty(c, path("faulty"));
  const int faults = fail_every_allocation(
      reference, faulty,
      [](const Solver& now, const Solver& expected) {
        expect_same(Observation(now), Observation(expected));
      },
      [](const Solver&) {});
  if (HasFailure()) return faults;
  const Observation now(*faulty.method), end(*reference.method);
  EXPECT_EQ(end.slept_updates > 0, c.steps > 64);
  expect_same_bits(now.particles, end.particles);
  expect_same_counters(now.counters, end.counters);
  EXPECT_EQ(now.slept_updates, end.slept_updates);
  EXPECT_EQ(now.energy.residual(), end.energy.residual());
  RecordProperty("faults", faults);
  return faults;
}

TEST_F(MpmFaultInjection, FailuresBesideAMovingObstacleLeaveTheStateUnchanged) {
  EXPECT_GE(try_all({1, 0.01, 100, true}), 500);
}

TEST_F(MpmFaultInjection, FailuresOnTwoThreadsLeaveTheStateUnchanged) {
  EXPECT_GE(try_all({2, 0.0025, 12, false}), 500);
}

/// During its lifetime no file of this process grows beyond a number of bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_;
};

TEST_F(MpmFaultInjection, AFullDiskLeavesTheLastCheckpointUnchanged) {
  std::signal(SIGXFSZ, SIG_IGN);  // otherwise the signal ends the process
  SnowCalls sequence({1, 0.0025, 12, false}, path("checkpoint"));
  for (std::size_t k = 0; k < 4; ++k) sequence.calls[k]();
  sequence.save_now();
  const std::string good = content(path("checkpoint"));
  sequence.method->step();
  int faults = 0;
  for (std::size_t bytes = 0; bytes < good.size(); bytes += good.size() / 20) {
    const FullDisk disk(bytes);
    EXPECT_THROW(sequence.save_now(), FileError) << bytes;
    ++faults;
  }
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 20);
  EXPECT_EQ(number_of_files(), 1u);
  EXPECT_EQ(content(path("checkpoint")), good);
  sequence.save_now();
  EXPECT_NE(content(path("checkpoint")), good);
}

TEST(MpmFailure, ABadBatchIsRefusedWithAllOthers) {
  const auto solver = make_solver(options_for({2, Precision::float32}), {});
  const ParticleBatch valid = filled_box(2, Vec3(0, 0, 0), Vec3(0.05, 0, 0.05), 0.005);
  ParticleBatch far = valid, foreign = valid;
  far.positions.back().x() = 1e9;
  foreign.material_id = 1;
  solver->add(valid);
  run_steps(*solver, 5);
  const SnowState before = snow_state(*solver);
  EXPECT_THROW(solver->add({valid, far}), SimulationError);
  EXPECT_THROW(solver->replace({valid, far}), SimulationError);
  EXPECT_THROW(solver->add({valid, foreign}), InputError);
  std::vector<double> drops(solver->size(), 0.01);
  drops.back() = 1e9;
  EXPECT_THROW(solver->settle(drops, std::vector<double>(solver->size())), SimulationError);
  expect_same_bits(snow_state(*solver), before);
  EXPECT_NO_THROW(run_steps(*solver, 100));
}

TEST(MpmFailure, AnImpossibleStepLeavesTheSnowUnchanged) {
  const auto solver = make_solver(options_for({2, Precision::float32}), {});
  solver->add(filled_box(2, Vec3(0, 0, 0), Vec3(0.05, 0, 0.05), 0.005));
  std::vector<Vec3> velocity_changes(solver->size(), Vec3(1e13, 0, 0));
  for (std::size_t i = 0; i < velocity_changes.size(); i += 2)
    velocity_changes[i] = -velocity_changes[i];
  solver->add_velocity(velocity_changes);
  const SnowState before = snow_state(*solver);
  for (int attempt = 0; attempt < 2; ++attempt) {
    EXPECT_THROW(solver->step(), SimulationError);
    expect_same_bits(snow_state(*solver), before);
    EXPECT_EQ(solver->time(), 0.0);
    EXPECT_EQ(solver->counters().rejected, 0);
  }
}

/// Snow that is too soft for the impact.
TEST(MpmFailure, AFailureDetectedAfterAStepEndsTheRun) {
  Options o = options_for({2, Precision::float32});
  o.snows[0].model = material::SnowModel::elastic;
  o.snows[0].youngs_modulus = 10;
  const auto solver =
      make_solver(o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
  ParticleBatch lump = filled_box(2, Vec3(0, 0, 0.01), Vec3(0.05, 0, 0.06), 0.005);
  lump.velocity.z() = -20;
  solver->add(lump);
  EXPECT_THROW(run_until(*solver, 0.1), SimulationError);
  const double time = solver->time();
  const auto refuses = [&](const auto& action) {
    try {
      action();
      FAIL();
    } catch (const SimulationError& error) {
      EXPECT_NE(std::string(error.what()).find("the simulation has failed"), std::string::npos);
    }
  };
  io::BinaryWriter out;
  refuses([&] { solver->step(); });
  refuses([&] { solver->add(lump); });
  refuses([&] { solver->replace({lump}); });
  refuses([&] { solver->save(out); });
  EXPECT_EQ(solver->time(), time);
  EXPECT_EQ(solver->state().positions.size(), solver->size());
}

}  // namespace
}  // namespace snowshed::methods::mpm
