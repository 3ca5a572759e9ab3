// Lack of memory with grains: every allocation fails once in a run in which bonds break and pairs
// are searched again. Each failed call must leave the grains as they were, and the run must end
// with the same bits.
#include "io/temporary_folder.hpp"
#include "methods/fault_story.hpp"
#include "methods/grains/grains_testing.hpp"

namespace snowshed::grains {
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

struct GrainsStory : FaultStory<Solver> {
  explicit GrainsStory(std::filesystem::path file) : FaultStory(weak_grains(), std::move(file)) {
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

void expect_same_grains(const Solver& now, const Solver& wanted) {
  const ParticleState a = now.state(), b = wanted.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(now.time(), wanted.time());
  EXPECT_EQ(now.counters().steps, wanted.counters().steps);
  EXPECT_EQ(now.counters().sorts, wanted.counters().sorts);
  EXPECT_EQ(now.energies(), wanted.energies());
  EXPECT_EQ(now.measures().bonds, wanted.measures().bonds);
  EXPECT_EQ(now.measures().stage, wanted.measures().stage);
}

class GrainsFaults : public TemporaryFolder {};

TEST_F(GrainsFaults, LeaveNoTrace) {
  GrainsStory whole(path("whole")), faulty(path("faulty"));
  std::int64_t max_broken = 0;
  const int faults = fail_every_allocation(whole, faulty, expect_same_grains, [&](const Solver& m) {
    max_broken = std::max(max_broken, m.measures().broken_in_tension);
  });
  if (HasFailure()) return;
  EXPECT_GT(max_broken, 0);
  EXPECT_GT(whole.method->counters().sorts, 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 200);
}

}  // namespace
}  // namespace snowshed::grains
