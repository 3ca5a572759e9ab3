// Lack of memory with a fluid of particles: every allocation of a run with erosion, both kinds of
// walls and a checkpoint fails once. Each failed call must leave the snow unchanged, and the run
// must end with the same bits.
#include "io/temporary_folder.hpp"
#include "methods/call_sequence.hpp"
#include "methods/mps/mps_testing.hpp"

namespace snowshed::methods::mps {
namespace {

Options eroding_tank(int dimension, Walls walls) {
  Options o = tank(dimension, 0.2, 0.025);
  o.settings.walls = walls;
  o.settings.density = 200;
  o.settings.rheology = ShearLaw::bingham_dilatant;
  o.settings.cohesion = 20;
  o.settings.yield_iterations = 3;
  o.settings.erosion = true;
  o.settings.erodible_thickness = 0.05;
  o.energy = true;
  return o;
}

struct MpsCalls : CallSequence<Solver> {
  MpsCalls(const Options& o, std::filesystem::path file)
      : CallSequence(make_solver(o), std::move(file)) {
    const ParticleBatch low = block_of(o, Vec3::Zero(), {0.2, 0.1, 0.05});
    ParticleBatch column = block_of(o, {0, 0, 0.05}, {0.1, 0.1, 0.15});
    column.velocity = {1, 0, -0.5};
    call([low, column](Solver& m) { m.add({low, column}); });
    take_steps(4);
    save();
    call([](Solver& m) { m.add_velocity(std::vector<Vec3>(m.size(), Vec3(0.1, 0, 0))); });
    take_steps(3);
    load();
    take_steps(2);
    call([column](Solver& m) { m.replace({column}); });
    take_steps(2);
  }
};

void expect_same_snow(const Solver& actual, const Solver& expected) {
  const ParticleState a = actual.state(), b = expected.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(values_by_id(actual, "pressure"), values_by_id(expected, "pressure"));
  EXPECT_EQ(actual.time(), expected.time());
  EXPECT_EQ(actual.time_step(), expected.time_step());
  EXPECT_EQ(actual.counters().steps, expected.counters().steps);
  EXPECT_EQ(actual.energies(), expected.energies());
  EXPECT_EQ(actual.report().mean_pressure_iterations, expected.report().mean_pressure_iterations);
}

class MpsFaultInjection : public io::TemporaryFolder, public testing::WithParamInterface<Walls> {};

TEST_P(MpsFaultInjection, FailedAllocationsLeaveTheStateUnchanged) {
  int faults = 0;
  for (const int dimension : {2, 3}) {
    const Options o = eroding_tank(dimension, GetParam());
    MpsCalls reference(o, path("reference")), faulty(o, path("faulty"));
    faults += fail_every_allocation(reference, faulty, expect_same_snow, [](const Solver&) {});
    if (HasFailure()) return;
  }
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 500);
}

INSTANTIATE_TEST_SUITE_P(, MpsFaultInjection, testing::Values(Walls::mirrors, Walls::particles),
                         [](const auto& chosen) {
                           return chosen.param == Walls::mirrors ? "mirrors" : "particles";
                         });

}  // namespace
}  // namespace snowshed::methods::mps
