#include "snowshed/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/readers/npy_testing.hpp"
#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::run {
namespace {

class SimulationTest : public io::TemporaryFolder {};

TEST_F(SimulationTest, ResumingDoesNotChangeTheBits) {
  for (methods::mpm::Transfer transfer :
       {methods::mpm::Transfer::flip, methods::mpm::Transfer::apic})
    for (methods::Between between : {methods::Between::carry, methods::Between::reseed}) {
      scene::Scene scene = small_scene(transfer);
      scene.events.between = between;
      Simulation reference(scene);
      for (int event = 0; event < scene.events.count; ++event) {
        reference.begin_event();
        reference.run(keep_running, never);
      }
      const auto resumed = with_interruptions(scene, 2, path("checkpoint"));
      expect_same_bits(*resumed, reference);
      EXPECT_GT(reference.method().counters().steps, 1000);
    }
}

TEST_F(SimulationTest, ThreadsDoNotChangeTheBits) {
  scene::Scene scene = small_scene();
  scene.events.count = 1;
  Simulation single(scene);
  single.begin_event();
  single.run(keep_running, never);
  scene.numerics.as<methods::mpm::Settings>().threads = 2;
  Simulation two(scene);
  two.begin_event();
  two.run(keep_running, never);
  expect_same_bits(single, two);
}

TEST_F(SimulationTest, EventsAddSnowAndKeepTheOldSnow) {
  const scene::Scene scene = small_scene();
  Simulation sim(scene);
  for (int event = 1; event <= 3; ++event) {
    EXPECT_FALSE(sim.begin_event().has_value());
    EXPECT_TRUE(sim.event_running());
    EXPECT_THROW(sim.begin_event(), SimulationError);
    EXPECT_NEAR(methods::mpm::total_mass(sim.method().state()), event * 210 * 0.1 * 0.03,
                1e-6 * event);
    sim.run(keep_running, never);
    EXPECT_THROW(sim.run(keep_running, never), SimulationError);
  }
  const methods::ParticleState s = sim.method().state();
  EXPECT_EQ(s.events.front(), 1);
  EXPECT_EQ(s.events.back(), 3);
  for (const Vec3& x : s.positions)
    EXPECT_GT(x.z(), -scene.numerics.as<methods::mpm::Settings>().dx);  // none in the ground
}

TEST_F(SimulationTest, ReseedingKeepsTheMass) {
  scene::Scene scene = small_scene();
  scene.events.between = methods::Between::reseed;
  Simulation sim(scene);
  EXPECT_FALSE(sim.begin_event().has_value());
  sim.run(keep_running, never);
  const double before = methods::mpm::total_mass(sim.method().state());
  EXPECT_TRUE(sim.begin_event().has_value());
  const methods::ParticleState s = sim.method().state();
  EXPECT_NEAR(methods::mpm::total_mass(s), 2 * before, 1e-5 * before);
}

/// A grid file of a solid, spacing 0.02 m.
std::string solid_grid() {
  using namespace geometry_testing;
  std::vector<double> distances;
  for (int i = -2; i <= 2; ++i)
    for (int k = -2; k <= 2; ++k) distances.push_back(0.02 * std::hypot(i, k) - 0.03);
  return npy_file(1, npy_header("<f8", "(5, 5)"), npy_data(distances));
}

TEST_F(SimulationTest, AFailedStartOfAnEventChangesNothing) {
  for (const methods::Between between : {methods::Between::carry, methods::Between::reseed}) {
    scene::Scene scene = small_scene();
    scene.events.between = between;
    scene::BodySpec body;
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
    sim.run(keep_running, never);
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
      sim.run(keep_running, never);
    }
    expect_same_bits(sim, *undisturbed);
  }
}

TEST_F(SimulationTest, SnowBeyondTheGridIsNotAdded) {
  scene::Scene scene = small_scene();
  scene::BodySpec far;
  far.event = 2;
  far.shape.type = "sphere";
  far.shape.radius = 0.02;
  far.shape.center = {1e6, 0, 0};
  scene.bodies.push_back(far);
  Simulation sim(scene);
  sim.begin_event();
  sim.run(keep_running, never);
  const std::size_t n = sim.method().size();
  EXPECT_THROW(sim.begin_event(), InputError);
  EXPECT_EQ(sim.method().size(), n);
  EXPECT_EQ(sim.method().state().positions.size(), n);
}

TEST_F(SimulationTest, InvalidCheckpointsDoNotReplaceValidOnes) {
  Simulation sim(small_scene());
  sim.begin_event();
  sim.save(path("checkpoint"));
  const std::string good = content(path("checkpoint"));
  // Infinite in single precision.
  sim.add_velocity(std::vector<Vec3>(sim.method().size(), Vec3(1e300, 0, 0)));
  const std::string message =
      io::message_of<SimulationError>([&] { sim.save(path("checkpoint")); });
  EXPECT_NE(message.find("not a finite number"), std::string::npos) << message;
  EXPECT_TRUE(content(path("checkpoint")) == good);
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(SimulationTest, EndsAtRestOrAtTheTimeLimit) {
  scene::Scene scene = small_scene();
  scene.events.count = 1;
  scene.events.max_time = 0.05;
  Simulation limited(scene);
  limited.begin_event();
  EXPECT_EQ(limited.run(keep_running, never), RunEnd::time_limit);
  EXPECT_GE(limited.event_time(), 0.05);
  EXPECT_LT(limited.event_time(), 0.06);

  scene.panel->friction = 2;  // the snow stays on the panel
  scene.events.max_time = 2;
  Simulation held(scene);
  held.begin_event();
  EXPECT_EQ(held.run(keep_running, never), RunEnd::rest);
  EXPECT_LT(held.event_time(), 0.5);
  EXPECT_EQ(held.method().motion(0.02).moving_mass, 0.0);
}

TEST_F(SimulationTest, ReportsProgressToItsObserver) {
  scene::Scene scene = small_scene();
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

TEST_F(SimulationTest, SnapshotsFormASeriesOverAllEvents) {
  scene::Scene scene = small_scene();
  scene.events.count = 2;
  Simulation sim(scene);
  sim.write_snapshots(path("snapshots"), 0.1);
  for (int event = 0; event < 2; ++event) {
    sim.begin_event();
    sim.run(keep_running, never);
  }
  const auto files = std::distance(std::filesystem::directory_iterator(path("snapshots")), {});
  EXPECT_GE(files, 1 + int(sim.method().time() / 0.1));  // and the index
  sim.write_vtp(path("end.vtp"));
  EXPECT_TRUE(std::filesystem::exists(path("end.vtp")));
}

TEST_F(SimulationTest, RefusesDamagedCheckpoints) {
  scene::Scene scene = small_scene();
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
}  // namespace snowshed::run
