#include "snowshed/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/readers/npy_testing.hpp"
#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

class SimulationTest : public TemporaryFolder {};

TEST_F(SimulationTest, AResumedRunEqualsAnUninterruptedOneBitForBit) {
  for (mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
    for (Between between : {Between::carry, Between::reseed}) {
      Scene scene = small_scene(transfer);
      scene.events.between = between;
      Simulation whole(scene);
      for (int event = 0; event < scene.events.count; ++event) {
        whole.begin_event();
        whole.run(go_on, never);
      }
      const auto resumed = with_interruptions(scene, 2, path("checkpoint"));
      expect_same_bits(*resumed, whole);
      EXPECT_GT(whole.method().counters().steps, 1000);
    }
}

TEST_F(SimulationTest, ThreadsDoNotChangeTheBits) {
  Scene scene = small_scene();
  scene.events.count = 1;
  Simulation one(scene);
  one.begin_event();
  one.run(go_on, never);
  scene.numerics.as<mpm::Settings>().threads = 2;
  Simulation two(scene);
  two.begin_event();
  two.run(go_on, never);
  expect_same_bits(one, two);
}

TEST_F(SimulationTest, EventsBringTheirSnowAndKeepTheOld) {
  const Scene scene = small_scene();
  Simulation sim(scene);
  for (int event = 1; event <= 3; ++event) {
    EXPECT_FALSE(sim.begin_event().has_value());
    EXPECT_TRUE(sim.event_running());
    EXPECT_THROW(sim.begin_event(), SimulationError);
    EXPECT_NEAR(mpm::total_mass(sim.method().state()), event * 210 * 0.1 * 0.03, 1e-6 * event);
    sim.run(go_on, never);
    EXPECT_THROW(sim.run(go_on, never), SimulationError);
  }
  const ParticleState s = sim.method().state();
  EXPECT_EQ(s.events.front(), 1);
  EXPECT_EQ(s.events.back(), 3);
  for (const Vec3& x : s.positions)
    EXPECT_GT(x.z(), -scene.numerics.as<mpm::Settings>().dx);  // none in the ground
}

TEST_F(SimulationTest, ReseedingKeepsTheMass) {
  Scene scene = small_scene();
  scene.events.between = Between::reseed;
  Simulation sim(scene);
  EXPECT_FALSE(sim.begin_event().has_value());
  sim.run(go_on, never);
  const double before = mpm::total_mass(sim.method().state());
  EXPECT_TRUE(sim.begin_event().has_value());
  const ParticleState s = sim.method().state();
  EXPECT_NEAR(mpm::total_mass(s), 2 * before, 1e-5 * before);
}

/// A grid file of a solid, spacing 0.02 m.
std::string solid_grid() {
  using namespace geometry_testing;
  std::vector<double> distances;
  for (int i = -2; i <= 2; ++i)
    for (int k = -2; k <= 2; ++k) distances.push_back(0.02 * std::hypot(i, k) - 0.03);
  return npy_file(1, npy_header("<f8", "(5, 5)"), npy_data(distances));
}

TEST_F(SimulationTest, AnEventThatCannotBeginLeavesAllAsItWas) {
  for (const Between between : {Between::carry, Between::reseed}) {
    Scene scene = small_scene();
    scene.events.between = between;
    BodySpec body;
    body.event = 2;
    body.shape.type = "grid";
    body.shape.file = path("solid.npy").string();
    body.shape.origin = {0.4, 0, 0.1};
    body.shape.spacing = 0.02;
    scene.bodies.push_back(body);
    write_plainly(path("solid.npy"), solid_grid());
    const auto undisturbed = run_all(scene);

    Simulation sim(scene);
    sim.begin_event();
    sim.run(go_on, never);
    sim.save(path("before"));
    write_plainly(path("solid.npy"), "spoilt");
    EXPECT_THROW(sim.begin_event(), InputError);
    EXPECT_EQ(sim.event(), 1);
    EXPECT_FALSE(sim.event_running());
    sim.save(path("after"));
    EXPECT_TRUE(content(path("after")) == content(path("before")));

    write_plainly(path("solid.npy"), solid_grid());
    while (sim.event() < scene.events.count) {
      sim.begin_event();
      sim.run(go_on, never);
    }
    expect_same_bits(sim, *undisturbed);
  }
}

TEST_F(SimulationTest, SnowBeyondTheGridIsNotAdded) {
  Scene scene = small_scene();
  BodySpec far;
  far.event = 2;
  far.shape.type = "sphere";
  far.shape.radius = 0.02;
  far.shape.center = {1e6, 0, 0};
  scene.bodies.push_back(far);
  Simulation sim(scene);
  sim.begin_event();
  sim.run(go_on, never);
  const std::size_t n = sim.method().size();
  EXPECT_THROW(sim.begin_event(), InputError);
  EXPECT_EQ(sim.method().size(), n);
  EXPECT_EQ(sim.method().state().positions.size(), n);
}

TEST_F(SimulationTest, ACheckpointIsNotReplacedByOneThatCannotBeLoaded) {
  Simulation sim(small_scene());
  sim.begin_event();
  sim.save(path("checkpoint"));
  const std::string good = content(path("checkpoint"));
  // Infinite in single precision.
  sim.add_velocity(std::vector<Vec3>(sim.method().size(), Vec3(1e300, 0, 0)));
  const std::string message = message_of<SimulationError>([&] { sim.save(path("checkpoint")); });
  EXPECT_NE(message.find("not a finite number"), std::string::npos) << message;
  EXPECT_TRUE(content(path("checkpoint")) == good);
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(SimulationTest, EndsAtRestOrAtTheTimeLimit) {
  Scene scene = small_scene();
  scene.events.count = 1;
  scene.events.max_time = 0.05;
  Simulation cut(scene);
  cut.begin_event();
  EXPECT_EQ(cut.run(go_on, never), RunEnd::time_limit);
  EXPECT_GE(cut.event_time(), 0.05);
  EXPECT_LT(cut.event_time(), 0.06);

  scene.panel->friction = 2;  // it stays on the panel
  scene.events.max_time = 2;
  Simulation held(scene);
  held.begin_event();
  EXPECT_EQ(held.run(go_on, never), RunEnd::rest);
  EXPECT_LT(held.event_time(), 0.5);
  EXPECT_EQ(held.method().motion(0.02).moving_mass, 0.0);
}

TEST_F(SimulationTest, ReportsProgressToItsObserver) {
  Scene scene = small_scene();
  scene.events.count = 1;
  Simulation sim(scene);
  sim.begin_event();
  double last = 0;
  std::int64_t reports = 0;
  sim.run(
      [&](const RunReport& r) {
        EXPECT_GE(r.time, last);
        EXPECT_GT(r.time_step, 0.0);
        EXPECT_GE(r.progress, 0.0);
        EXPECT_LT(r.progress, 1.0);
        EXPECT_EQ(r.particles, sim.method().size());
        last = r.time;
        return ++reports < 100;
      },
      0.0);
  EXPECT_GE(reports, 100);
}

TEST_F(SimulationTest, SnapshotsAreASeriesOverAllEvents) {
  Scene scene = small_scene();
  scene.events.count = 2;
  Simulation sim(scene);
  sim.write_snapshots(path("snapshots"), 0.1);
  for (int event = 0; event < 2; ++event) {
    sim.begin_event();
    sim.run(go_on, never);
  }
  const auto files = std::distance(std::filesystem::directory_iterator(path("snapshots")), {});
  EXPECT_GE(files, 1 + int(sim.method().time() / 0.1));  // and the index
  sim.write_vtp(path("end.vtp"));
  EXPECT_TRUE(std::filesystem::exists(path("end.vtp")));
}

TEST_F(SimulationTest, RefusesDamagedCheckpoints) {
  Scene scene = small_scene();
  Simulation sim(scene);
  sim.begin_event();
  sim.run([](const RunReport&) { return false; }, 0.0);
  sim.save(path("good"));
  const std::string bytes = content(path("good"));
  write_plainly(path("short"), bytes.substr(0, bytes.size() / 2));
  EXPECT_THROW(Simulation::load(path("short")), InputError);
  std::string flipped = bytes;
  flipped[bytes.size() / 2] ^= 1;
  write_plainly(path("flipped"), flipped);
  EXPECT_THROW(Simulation::load(path("flipped")), InputError);
  EXPECT_THROW(Simulation::load(path("absent")), FileError);
}

}  // namespace
}  // namespace snowshed
