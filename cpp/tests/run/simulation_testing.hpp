// Shared parts of the tests of simulations: a small scene, and its runs with and without pauses.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/fields_by_id.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed::run {

/// A slab that slides off a small panel onto the ground, in some 2000 steps per event.
inline scene::Scene small_scene(methods::mpm::Transfer transfer = methods::mpm::Transfer::flip) {
  scene::Scene scene;
  scene.dimension = 2;
  scene.panel.emplace();
  scene.panel->height = 0.05;
  scene.panel->length = 0.1;
  scene.panel->tilt = 50;
  scene.panel->friction = 0.2;
  scene.slab.emplace();
  scene.slab->thickness = 0.03;
  scene.ground.emplace();
  scene.numerics.as<methods::mpm::Settings>().transfer = transfer;
  scene.numerics.as<methods::mpm::Settings>().threads = 1;
  scene.events.count = 3;
  scene.events.max_time = 0.3;
  scene.output.energy = true;
  return scene;
}

inline const auto keep_running = [](const RunReport&) { return true; };
inline constexpr double never = 1e9;

/// A box of snow that falls on the ground so fast that it yields and its particles mix.
inline scene::Scene falling_box(int dimension, methods::mpm::Precision precision) {
  scene::Scene scene;
  scene.dimension = dimension;
  scene.ground.emplace();
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "box";
  body.shape.center = {0, 0, 0.12};
  body.shape.size = {0.2, 0.2, 0.2};
  body.velocity = {0.5, dimension == 3 ? 0.2 : 0.0, -3};
  auto& settings = scene.numerics.as<methods::mpm::Settings>();
  settings.precision = precision;
  settings.dx = 0.025;
  return scene;
}

/// Expects that some particles have yielded, so that the law's state has changed.
inline void expect_yielded(const Simulation& sim) {
  const auto strain = sim.method().field("volumetric_plastic_strain");
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < strain.count; ++i) {
    const double value = strain.info.type == particles::FieldType::float32
                             ? double(static_cast<const float*>(strain.elements.get())[i])
                             : static_cast<const double*>(strain.elements.get())[i];
    low = std::min(low, value), high = std::max(high, value);
  }
  EXPECT_GT(high - low, 1e-5);
}

inline void expect_same_bits(const Simulation& a, const Simulation& b) {
  const methods::ParticleState x = a.method().state(), y = b.method().state();
  EXPECT_TRUE(x.positions == y.positions);
  EXPECT_TRUE(x.velocities == y.velocities);
  for (const char* name : {"volumetric_plastic_strain", "pressure"})
    EXPECT_EQ(methods::values_by_id(a.method(), name), methods::values_by_id(b.method(), name));
  EXPECT_EQ(x.events, y.events);
  EXPECT_EQ(x.material_ids, y.material_ids);
  EXPECT_EQ(a.method().time(), b.method().time());
  EXPECT_EQ(a.method().counters().steps, b.method().counters().steps);
  EXPECT_EQ(methods::capability<methods::KeepsEnergy>(a.method())->energies(),
            methods::capability<methods::KeepsEnergy>(b.method())->energies());
  EXPECT_EQ(a.event(), b.event());
}

/// Runs all events.
inline std::unique_ptr<Simulation> run_all(const scene::Scene& scene) {
  auto sim = std::make_unique<Simulation>(scene);
  for (int event = 0; event < scene.events.count; ++event) {
    sim->begin_event();
    sim->run(keep_running, never);
  }
  return sim;
}

/// Runs all events, saving and loading `times` times within each and once between them.
inline std::unique_ptr<Simulation> with_interruptions(const scene::Scene& scene, int times,
                                                      const std::filesystem::path& file) {
  auto sim = std::make_unique<Simulation>(scene);
  const auto reload = [&] {
    sim->save(file);
    sim = Simulation::load(file);
  };
  for (int event = 0; event < scene.events.count; ++event) {
    sim->begin_event();
    for (int i = 0; i < times; ++i) {
      int steps = 0;
      const RunEnd end = sim->run([&](const RunReport&) { return ++steps < 300; }, 0.0);
      EXPECT_EQ(end, RunEnd::paused);
      reload();
      EXPECT_TRUE(sim->event_running());
    }
    EXPECT_NE(sim->run(keep_running, never), RunEnd::paused);
    EXPECT_FALSE(sim->event_running());
    reload();
    EXPECT_EQ(sim->event(), event + 1);
  }
  return sim;
}

}  // namespace snowshed::run
