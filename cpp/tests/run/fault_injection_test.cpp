// Lack of memory in a simulation: every allocation of two events fails once. After each failure the
// simulation continues to the same bits, and a checkpoint written before still loads. (Reading a
// scene from JSON is left out: the JSON library ends the process.)
#include <gtest/gtest.h>

#include <functional>

#include "core/allocation_fault.hpp"
#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"

namespace snowshed::run {
namespace {

/// Two events with all calls that a driver makes during and between them.
class EventCalls {
 public:
  explicit EventCalls(const std::filesystem::path& checkpoint) : checkpoint_(checkpoint) {
    scene::Scene scene = small_scene();
    scene.numerics.as<methods::mpm::Settings>().dx = 0.02;
    scene.events.count = 2;
    scene.events.between = methods::Between::reseed;
    sim = std::make_unique<Simulation>(scene);
  }

  std::unique_ptr<Simulation> sim;

  /// Calls that succeed or change nothing.
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
  static methods::ParticleBatch more_snow() {
    return methods::mpm::filled_box(2, Vec3(0.3, 0, 0.1), Vec3(0.34, 0, 0.12), 0.01);
  }

  std::filesystem::path checkpoint_;
};

/// Whether a call throws std::bad_alloc at its n-th allocation.
bool fails_at(std::int64_t n, const std::function<void()>& call) {
  return with_allocation_fault(n, call) == FaultOutcome::failed;
}

/// Positions may have been rounded, because the sort of a failed step is kept.
void expect_unchanged(const Simulation& sim, const methods::ParticleState& particles, double time,
                      int event, bool running) {
  const methods::ParticleState s = sim.method().state();
  ASSERT_EQ(s.ids, particles.ids);
  for (std::size_t i = 0; i < s.ids.size(); ++i)
    ASSERT_LT((s.positions[i] - particles.positions[i]).norm(), 1e-8);
  EXPECT_TRUE(s.velocities == particles.velocities);
  EXPECT_EQ(sim.method().time(), time);
  EXPECT_EQ(sim.event(), event);
  EXPECT_EQ(sim.event_running(), running);
}

class SimulationFaultInjection : public io::TemporaryFolder {
 protected:
  /// Lets each allocation of each call fail once, until the call succeeds.
  void make_all(EventCalls& sequence, const std::vector<std::function<void()>>& calls) {
    for (std::size_t k = 0; k < calls.size(); ++k) {
      const methods::ParticleState before = sequence.sim->method().state();
      const double time = sequence.sim->method().time();
      const int event = sequence.sim->event();
      const bool running = sequence.sim->event_running();
      for (std::int64_t n = 1; fails_at(n, calls[k]); ++n) {
        SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
        expect_unchanged(*sequence.sim, before, time, event, running);
        if (std::filesystem::exists(path("faulty")) && n % 16 == 1)
          EXPECT_NO_THROW(Simulation::load(path("faulty")));
        if (HasFailure()) return;
        ++faults_;
      }
    }
  }

  /// Runs the current event to its end, and lets each allocation fail once.
  void run_to_end(EventCalls& sequence) {
    for (std::int64_t n = 1; fails_at(n, [&] { sequence.sim->run(keep_running, never); }); ++n)
      ++faults_;
  }

  int faults_ = 0;
};

TEST_F(SimulationFaultInjection, FailedAllocationsDoNotChangeTheRun) {
  EventCalls reference(path("reference")), faulty(path("faulty"));
  for (const auto& call : reference.calls()) call();
  reference.sim->run(keep_running, never);
  for (const auto& call : reference.later_calls()) call();
  reference.sim->run(keep_running, never);

  make_all(faulty, faulty.calls());
  run_to_end(faulty);
  make_all(faulty, faulty.later_calls());
  run_to_end(faulty);
  expect_same_bits(*faulty.sim, *reference.sim);
  RecordProperty("faults", faults_);
  EXPECT_GE(faults_, 500);
}

}  // namespace
}  // namespace snowshed::run
