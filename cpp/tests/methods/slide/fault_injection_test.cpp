// Lack of memory with a slide: every allocation fails once in a run that entrains snow and loses
// some over the edge of the terrain. Each failed call must leave the snow unchanged, and the run
// must end with the same bits.
#include "io/temporary_folder.hpp"
#include "methods/call_sequence.hpp"
#include "methods/slide/slide_testing.hpp"

namespace snowshed::methods::slide {
namespace {

std::unique_ptr<Solver> eroding_slide() {
  Options o = slide_on(inclined(38, 45, 25), rectangle(56.3, 18.3, 84.3, 32.3));
  o.areas.entrainment = {rectangle(60, 6, 86, 42, 0.3)};
  o.areas.resistance = {rectangle(70, 10, 80, 20)};
  o.areas.secondary_release = {rectangle(60.3, 38.3, 66.3, 44.3)};
  o.areas.inflows = {{rectangle(20.3, 20.3, 26.3, 26.3), true, {{0.31, 0.4, 6}}}};
  o.areas.dams = {{"dam", {{78, 20, 1}, {80, 30, 1}}, 90, 0.2}};
  o.settings.detrainment = 20;
  o.settings.ground_gains_stopped = o.settings.ground_gains_detrained = true;
  o.settings.ground_loses_entrained = true;
  o.settings.ground_min_change = 0.001;
  o.settings.ground_rest_time = 0.05;
  return make_solver(o);
}

struct SlideCalls : CallSequence<Solver> {
  explicit SlideCalls(std::filesystem::path file) : CallSequence(eroding_slide(), std::move(file)) {
    call([](Solver& m) { m.add(m.seed()); });
    take_steps(60);
    save();
    call([](Solver& m) { m.add_velocity(std::vector<Vec3>(m.size(), Vec3(12, 0, -9))); });
    take_steps(150);  // until snow has left the terrain
    load();
    take_steps(60);
  }
};

/// Compares what callers can read of a slide. The order in memory may differ.
void expect_same_slide(const Solver& actual, const Solver& expected) {
  const ParticleState a = actual.state(), b = expected.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(actual.time(), expected.time());
  EXPECT_EQ(actual.counters().steps, expected.counters().steps);
  EXPECT_EQ(actual.peaks().speed, expected.peaks().speed);
  EXPECT_EQ(actual.bonds().rest_length, expected.bonds().rest_length);
  EXPECT_EQ(actual.mass_balance().entrained, expected.mass_balance().entrained);
  EXPECT_EQ(actual.mass_balance().left_terrain, expected.mass_balance().left_terrain);
  EXPECT_EQ(actual.mass_balance().stopped, expected.mass_balance().stopped);
  EXPECT_EQ(actual.ground()->change(), expected.ground()->change());
  EXPECT_EQ(actual.ground()->rise, expected.ground()->rise);
}

class SlideFaultInjection : public io::TemporaryFolder {};

TEST_F(SlideFaultInjection, FailedAllocationsLeaveTheStateUnchanged) {
  SlideCalls reference(path("reference")), faulty(path("faulty"));
  double max_left = 0;
  const int faults = fail_every_allocation(
      reference, faulty, expect_same_slide,
      [&](const Solver& m) { max_left = std::max(max_left, m.mass_balance().left_terrain); });
  if (HasFailure()) return;
  EXPECT_GT(reference.method->mass_balance().entrained, 0);
  EXPECT_GT(max_left, 0);
  EXPECT_GT(reference.method->mass_balance().inflow, 0);
  EXPECT_GT(reference.method->mass_balance().detrained, 0);
  EXPECT_NE(reference.method->ground()->volume(), 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 500);
}

}  // namespace
}  // namespace snowshed::methods::slide
