// Lack of memory with a slide: every allocation fails once in a run that entrains snow and loses
// some over the edge of the terrain. Each failed call must leave the snow as it was, and the run
// must end with the same bits.
#include "io/temporary_folder.hpp"
#include "methods/fault_story.hpp"
#include "methods/slide/slide_testing.hpp"

namespace snowshed::slide {
namespace {

std::unique_ptr<Solver> eroding_slide() {
  Options o = slide_on(inclined(38, 45, 25), rectangle(56.3, 18.3, 84.3, 32.3));
  o.areas.entrainment = {rectangle(60, 6, 86, 42, 0.3)};
  o.areas.resistance = {rectangle(70, 10, 80, 20)};
  return make_solver(o);
}

struct SlideStory : FaultStory<Solver> {
  explicit SlideStory(std::filesystem::path file) : FaultStory(eroding_slide(), std::move(file)) {
    call([](Solver& m) { m.add(m.seed()); });
    take_steps(60);
    save();
    call([](Solver& m) { m.add_velocity(std::vector<Vec3>(m.size(), Vec3(12, 0, -9))); });
    take_steps(150);  // until snow has left the terrain
    load();
    take_steps(60);
  }
};

/// Compares all that callers can read of a slide. The order of storage may differ.
void expect_same_slide(const Solver& now, const Solver& wanted) {
  const ParticleState a = now.state(), b = wanted.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(now.time(), wanted.time());
  EXPECT_EQ(now.counters().steps, wanted.counters().steps);
  EXPECT_EQ(now.peaks().speed, wanted.peaks().speed);
  EXPECT_EQ(now.bonds().rest_length, wanted.bonds().rest_length);
  EXPECT_EQ(now.mass_balance().entrained, wanted.mass_balance().entrained);
  EXPECT_EQ(now.mass_balance().left_terrain, wanted.mass_balance().left_terrain);
}

class SlideFaults : public TemporaryFolder {};

TEST_F(SlideFaults, LeaveNoTrace) {
  SlideStory whole(path("whole")), faulty(path("faulty"));
  double max_left = 0;
  const int faults = fail_every_allocation(whole, faulty, expect_same_slide, [&](const Solver& m) {
    max_left = std::max(max_left, m.mass_balance().left_terrain);
  });
  if (HasFailure()) return;
  EXPECT_GT(whole.method->mass_balance().entrained, 0);
  EXPECT_GT(max_left, 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 500);
}

}  // namespace
}  // namespace snowshed::slide
