// What becomes of grains when memory is short: every allocation of a run in which bonds break and
// pairs are looked for anew fails once. Each failed call must leave the grains as they were, and
// the run must end with the same bits.
#include <gtest/gtest.h>

#include "core/allocation_fault.hpp"
#include "io/temporary_folder.hpp"
#include "methods/grains/grains_testing.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed {
namespace {

class GrainsStory {
 public:
  explicit GrainsStory(std::filesystem::path file) : file_(std::move(file)) {
    GrainsOptions o = grains_of(random_snow(9, 4));
    o.settings.density_scaling = 1e4;
    o.settings.tensile_strength = 1e5;
    o.energy = true;
    o.cone = {1e-4, 30};
    o.loading = {{LoadingKind::compress, 10, 0.1, 0}, {LoadingKind::penetrate, 10, 0.2, 0}};
    grains = make_grains(o);
    calls = {[this] { grains->add(grains->seed()); }};
    take_steps(30);
    calls.push_back([this] { save(); });
    calls.push_back(
        [this] { grains->add_velocity(std::vector<Vec3>(grains->size(), Vec3(1, 0, 0))); });
    take_steps(60);
    calls.push_back([this] { grains->load(BinaryReader::load(file_)); });
    take_steps(20);
    calls.push_back([this] { grains->replace(grains->seed()); });
    take_steps(10);
  }

  std::unique_ptr<GrainsMethod> grains;
  std::vector<std::function<void()>> calls;

 private:
  void take_steps(int count) {
    for (int i = 0; i < count; ++i) calls.push_back([this] { grains->step(); });
  }
  void save() const {
    BinaryWriter out;
    grains->save(out);
    out.save(file_);
  }

  std::filesystem::path file_;
};

void expect_same_grains(const GrainsMethod& now, const GrainsMethod& wanted) {
  const ParticleState a = now.state(), b = wanted.state();
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(now.time(), wanted.time());
  EXPECT_EQ(now.counters().steps, wanted.counters().steps);
  EXPECT_EQ(now.counters().sorts, wanted.counters().sorts);
  EXPECT_EQ(now.energy_table(), wanted.energy_table());
  EXPECT_EQ(now.measures().bonds, wanted.measures().bonds);
  EXPECT_EQ(now.measures().stage, wanted.measures().stage);
}

class GrainsFaults : public TemporaryFolder {};

TEST_F(GrainsFaults, leave_no_trace) {
  GrainsStory whole(path("whole")), faulty(path("faulty"));
  int faults = 0;
  std::int64_t most_broken = 0;
  for (std::size_t k = 0; k < whole.calls.size(); ++k) {
    for (std::int64_t n = 1;; ++n) {
      const FaultOutcome outcome = with_allocation_fault(n, faulty.calls[k]);
      if (outcome == FaultOutcome::no_fault) break;
      ++faults;
      SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
      // Streams do without some memory; what reads or writes a file may be done again.
      if (outcome == FaultOutcome::done_without) whole.calls[k]();
      expect_same_grains(*faulty.grains, *whole.grains);
      if (HasFailure()) return;
    }
    whole.calls[k]();
    most_broken = std::max(most_broken, whole.grains->measures().broken_in_tension);
  }
  expect_same_grains(*faulty.grains, *whole.grains);
  EXPECT_GT(most_broken, 0);
  EXPECT_GT(whole.grains->counters().sorts, 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 200);
}

}  // namespace
}  // namespace snowshed
