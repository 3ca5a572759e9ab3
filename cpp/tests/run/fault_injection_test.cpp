// Lack of memory in a simulation: every allocation of two events fails once. After each failure the
// simulation goes on to the same bits, and a checkpoint written before it still loads. (Reading a
// scene from JSON is left out: the JSON library ends the process.)
#include <gtest/gtest.h>

#include <functional>

#include "core/allocation_fault.hpp"
#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"

namespace snowshed {
namespace {

/// Two events with all that a driver does in and between them.
class Story {
 public:
  explicit Story(const std::filesystem::path& checkpoint) : checkpoint_(checkpoint) {
    Scene scene = small_scene();
    scene.numerics.as<mpm::Settings>().dx = 0.02;
    scene.events.count = 2;
    scene.events.between = Between::reseed;
    sim = std::make_unique<Simulation>(scene);
  }

  std::unique_ptr<Simulation> sim;

  /// Calls that are all or nothing.
  std::vector<std::function<void()>> calls() {
    std::vector<std::function<void()>> all;
    const auto step = [&](int count) {
      for (int i = 0; i < count; ++i) all.push_back([this] { sim->step(); });
    };
    all.push_back([this] { sim->begin_event(); });
    step(40);
    all.push_back([this] { sim->save(checkpoint_); });
    all.push_back([this] { sim->add_snow(more_snow()); });
    step(40);
    all.push_back([this] { sim->save(checkpoint_); });
    return all;
  }

  /// Calls after the end of the first event.
  std::vector<std::function<void()>> later_calls() {
    std::vector<std::function<void()>> all;
    all.push_back([this] {
      const std::size_t n = sim->method().size();
      sim->settle(std::vector<double>(n, 1e-4), std::vector<double>(n, -1e-3));
    });
    all.push_back([this] { sim->begin_event(); });
    all.push_back([this] { sim->save(checkpoint_); });
    return all;
  }

 private:
  static ParticleBatch more_snow() {
    return mpm::filled_box(2, Vec3(0.3, 0, 0.1), Vec3(0.34, 0, 0.12), 0.01);
  }

  std::filesystem::path checkpoint_;
};

/// Whether a call runs short of memory at its n-th allocation, and says so.
bool fails_at(std::int64_t n, const std::function<void()>& call) {
  return with_allocation_fault(n, call) == FaultOutcome::failed;
}

/// Positions may have been rounded: the sort of a step that failed stays.
void expect_unchanged(const Simulation& now, const ParticleState& particles, double time, int event,
                      bool running) {
  const ParticleState s = now.method().state();
  ASSERT_EQ(s.ids, particles.ids);
  for (std::size_t i = 0; i < s.ids.size(); ++i)
    ASSERT_LT((s.positions[i] - particles.positions[i]).norm(), 1e-8);
  EXPECT_TRUE(s.velocities == particles.velocities);
  EXPECT_EQ(now.method().time(), time);
  EXPECT_EQ(now.event(), event);
  EXPECT_EQ(now.event_running(), running);
}

class SimulationFaults : public TemporaryFolder {
 protected:
  /// Lets each allocation of each call fail in turn, until the call is done.
  void make_all(Story& story, const std::vector<std::function<void()>>& calls) {
    for (std::size_t k = 0; k < calls.size(); ++k) {
      const ParticleState before = story.sim->method().state();
      const double time = story.sim->method().time();
      const int event = story.sim->event();
      const bool running = story.sim->event_running();
      for (std::int64_t n = 1; fails_at(n, calls[k]); ++n) {
        SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
        expect_unchanged(*story.sim, before, time, event, running);
        if (std::filesystem::exists(path("faulty")) && n % 16 == 1)
          EXPECT_NO_THROW(Simulation::load(path("faulty")));
        if (HasFailure()) return;
        ++faults_;
      }
    }
  }

  /// Runs the present event to its end, however often memory is short on the way.
  void run_to_end(Story& story) {
    for (std::int64_t n = 1; fails_at(n, [&] { story.sim->run(go_on, never); }); ++n) ++faults_;
  }

  int faults_ = 0;
};

TEST_F(SimulationFaults, LeaveWhatCanGoOnToTheSameBits) {
  Story whole(path("whole")), faulty(path("faulty"));
  for (const auto& call : whole.calls()) call();
  whole.sim->run(go_on, never);
  for (const auto& call : whole.later_calls()) call();
  whole.sim->run(go_on, never);

  make_all(faulty, faulty.calls());
  run_to_end(faulty);
  make_all(faulty, faulty.later_calls());
  run_to_end(faulty);
  expect_same_bits(*faulty.sim, *whole.sim);
  RecordProperty("faults", faults_);
  EXPECT_GE(faults_, 500);
}

}  // namespace
}  // namespace snowshed
