// Lack of memory with grains: every allocation fails once in a run in which bonds break and pairs
// are searched again. Each failed call must leave the grains unchanged, and the run must end
// with the same bits.
#include "io/temporary_folder.hpp"
#include "methods/call_sequence.hpp"
#include "methods/grains/grains_testing.hpp"

namespace snowshed::methods::grains {
namespace {

std::unique_ptr<Solver> weak_grains() {
  Options o = grains_of(random_snow(9, 4));
  o.settings.density_scaling = 1e4;
  o.settings.tensile_strength = 1e5;
  o.energy = true;
  o.cone = {1e-4, 30};
  o.loading = {{LoadingKind::compress, 10, 0.1, 0}, {LoadingKind::penetrate, 10, 0.2, 0}};
  return make_solver(o);
}

struct GrainsCalls : CallSequence<Solver> {
  explicit GrainsCalls(std::filesystem::path file) : CallSequence(weak_grains(), std::move(file)) {
    call([](Solver& m) { m.add(m.seed()); });
    take_steps(30);
    save();
    call([](Solver& m) { m.add_velocity(std::vector<Vec3>(m.size(), Vec3(1, 0, 0))); });
    take_steps(60);
    load();
    take_steps(20);
    call([](Solver& m) { m.replace(m.seed()); });
    take_steps(10);
  }
};

void expect_same_grains(const Solver& actual, const Solver& expected) {
  const ParticleState a = actual.state(), b = expected.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(actual.time(), expected.time());
  EXPECT_EQ(actual.counters().steps, expected.counters().steps);
  EXPECT_EQ(actual.pair_searches(), expected.pair_searches());
  EXPECT_EQ(actual.energies(), expected.energies());
  EXPECT_EQ(actual.measures().bonds, expected.measures().bonds);
  EXPECT_EQ(actual.measures().stage, expected.measures().stage);
}

class GrainsFaultInjection : public io::TemporaryFolder {};

TEST_F(GrainsFaultInjection, FailedAllocationsLeaveTheStateUnchanged) {
  GrainsCalls reference(path("reference")), faulty(path("faulty"));
  std::int64_t max_broken = 0;
  const int faults = fail_every_allocation(
      reference, faulty, expect_same_grains,
      [&](const Solver& m) { max_broken = std::max(max_broken, m.measures().broken_in_tension); });
  if (HasFailure()) return;
  EXPECT_GT(max_broken, 0);
  EXPECT_GT(reference.method->pair_searches(), 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 200);
}

}  // namespace
}  // namespace snowshed::methods::grains
