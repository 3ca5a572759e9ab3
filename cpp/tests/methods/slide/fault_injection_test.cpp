// What becomes of a slide when memory is short: every allocation of a run that entrains snow and
// loses some over the edge of the terrain fails once. Each failed call must leave the snow as it
// was, and the run must end with the same bits.
#include <gtest/gtest.h>

#include "core/allocation_fault.hpp"
#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed {
namespace {

class SlideStory {
 public:
  explicit SlideStory(std::filesystem::path file) : file_(std::move(file)) {
    SlideOptions o = slide_on(inclined(38, 45, 25), rectangle(56.3, 18.3, 84.3, 32.3));
    o.areas.entrainment = {rectangle(60, 6, 86, 42, 0.3)};
    o.areas.resistance = {rectangle(70, 10, 80, 20)};
    slide = make_slide(o);
    calls = {[this] { slide->add(slide->seed()); }};
    take_steps(60);
    calls.push_back([this] { save(); });
    calls.push_back(
        [this] { slide->add_velocity(std::vector<Vec3>(slide->size(), Vec3(12, 0, -9))); });
    take_steps(150);  // until snow has left the terrain
    calls.push_back([this] { slide->load(BinaryReader::load(file_)); });
    take_steps(60);
  }

  std::unique_ptr<SlideMethod> slide;
  std::vector<std::function<void()>> calls;

 private:
  void take_steps(int count) {
    for (int i = 0; i < count; ++i) calls.push_back([this] { slide->step(); });
  }
  void save() const {
    BinaryWriter out;
    slide->save(out);
    out.save(file_);
  }

  std::filesystem::path file_;
};

/// All that can be seen of a slide. Where the particles are stored may change.
void expect_same_slide(const SlideMethod& now, const SlideMethod& wanted) {
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
  EXPECT_EQ(now.mass_balance().left, wanted.mass_balance().left);
}

class SlideFaults : public TemporaryFolder {};

TEST_F(SlideFaults, leave_no_trace) {
  SlideStory whole(path("whole")), faulty(path("faulty"));
  int faults = 0;
  double most_left = 0;
  for (std::size_t k = 0; k < whole.calls.size(); ++k) {
    for (std::int64_t n = 1;; ++n) {
      const FaultOutcome outcome = with_allocation_fault(n, faulty.calls[k]);
      if (outcome == FaultOutcome::no_fault) break;
      ++faults;
      SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
      // Streams do without some memory; what reads or writes a file may be done again.
      if (outcome == FaultOutcome::done_without) whole.calls[k]();
      expect_same_slide(*faulty.slide, *whole.slide);
      if (HasFailure()) return;
    }
    whole.calls[k]();
    most_left = std::max(most_left, whole.slide->mass_balance().left);
  }
  expect_same_slide(*faulty.slide, *whole.slide);
  EXPECT_GT(whole.slide->mass_balance().entrained, 0);
  EXPECT_GT(most_left, 0);
  RecordProperty("faults", faults);
  EXPECT_GE(faults, 500);
}

}  // namespace
}  // namespace snowshed
