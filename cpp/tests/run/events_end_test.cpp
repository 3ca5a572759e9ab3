// The end of events, as the caller sees it: snow drifts without gravity at a known speed.
#include <gtest/gtest.h>

#include "run/simulation_testing.hpp"

namespace snowshed::run {
namespace {

scene::BodySpec drifting_box(double x, double size, double speed, int event) {
  scene::BodySpec body;
  body.shape.type = "box";
  body.shape.center = Vec3(x, 0, 1);
  body.shape.size = Vec3(size, 0, size);
  body.velocity = Vec3(speed, 0, 0);
  body.event = event;
  return body;
}

scene::Scene drift(std::vector<scene::BodySpec> bodies) {
  scene::Scene scene;
  scene.dimension = 2;
  scene.gravity = 0;
  scene.snow.youngs_modulus = 1e5;
  scene.numerics.as<methods::mpm::Settings>().dx = 0.02;
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0;
  scene.numerics.as<methods::mpm::Settings>().threads = 1;
  scene.bodies = std::move(bodies);
  scene.events.count = 2;
  scene.events.rest_speed = 0.02;
  scene.events.rest_time = 0.05;
  scene.events.max_time = 0.2;
  return scene;
}

RunEnd end_of_event(Simulation& sim) {
  sim.begin_event();
  return sim.run(keep_running, never);
}

TEST(EventEnd, ComesAtTheGivenSpeedAndTime) {
  for (const double speed : {0.018, 0.022}) {
    Simulation sim(drift({drifting_box(0, 0.1, speed, 1), drifting_box(1, 0.1, 0, 2)}));
    EXPECT_EQ(end_of_event(sim), speed < 0.02 ? RunEnd::rest : RunEnd::time_limit) << speed;
    EXPECT_NEAR(sim.event_time(), speed < 0.02 ? 0.05 : 0.2, 0.006) << speed;
  }
}

TEST(EventEnd, ComesWithinAStepOfTheTimeLimit) {
  scene::Scene scene = drift({drifting_box(0, 0.1, 1.0, 1), drifting_box(1, 0.1, 0, 2)});
  scene.events.rest_time = 0.15;  // the speed is checked ten times as often
  for (const double limit : {0.16, 0.1601, 0.1777}) {
    scene.events.max_time = limit;
    Simulation sim(scene);
    EXPECT_EQ(end_of_event(sim), RunEnd::time_limit);
    EXPECT_GE(sim.event_time(), limit - 1e-6 * sim.method().time_step());
    EXPECT_LT(sim.event_time(), limit + sim.method().time_step());
  }
}

TEST(EventEnd, ComesAfterTheStart) {
  scene::Scene scene = drift({drifting_box(0, 0.1, 0, 1), drifting_box(1, 0.1, 0, 2)});
  scene.events.rest_time = 0;
  Simulation sim(scene);
  EXPECT_EQ(end_of_event(sim), RunEnd::rest);
  EXPECT_GT(sim.event_time(), 0);
}

/// The path that an error of a scene names.
std::string refused_at(const scene::Scene& scene) {
  try {
    Simulation sim(scene);
    return "";
  } catch (const InputError& error) {
    return error.where();
  }
}

TEST(EventEnd, MoreThanATrillionStepsAreRefused) {
  scene::Scene scene = drift({drifting_box(0, 0.1, 0.01, 1)});
  EXPECT_EQ(refused_at(scene), "");
  for (const double factor : {1e-300, 1e-15, 1e-11}) {
    scene.numerics.as<methods::mpm::Settings>().courant_factor = factor;
    EXPECT_EQ(refused_at(scene), "/numerics/courant_factor") << factor;
  }
}

TEST(EventEnd, MoreThanAMillionRecordsAreRefused) {
  scene::Scene scene = drift({drifting_box(0, 0.1, 0.01, 1)});
  for (const double interval : {1e-300, 1e-9}) {
    scene.output.snapshot_interval = interval;
    EXPECT_EQ(refused_at(scene), "/output/snapshot_interval") << interval;
  }
  scene.output.snapshot_interval = 0;
  scene.output.film_interval = 1e-300;
  EXPECT_EQ(refused_at(scene), "/output/film_interval");
}

TEST(EventEnd, WaitsForASmallSlabBesideALargeStack) {
  Simulation sim(drift({drifting_box(0, 0.4, 0, 1), drifting_box(1, 0.1, 0.03, 2)}));
  EXPECT_EQ(end_of_event(sim), RunEnd::rest);
  EXPECT_EQ(end_of_event(sim), RunEnd::time_limit);
}

}  // namespace
}  // namespace snowshed::run
