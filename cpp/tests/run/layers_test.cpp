// Slabs of several layers, and new snow on snow that stayed on the panel.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/run/cost_report.hpp"
#include "snowshed/scene/event_bodies.hpp"
#include "snowshed/scene/panel_frame.hpp"

namespace snowshed::run {
namespace {

/// The first time step of a scene at rest, s.
double estimated_time_step(const scene::Scene& scene) { return estimate_cost(scene).time_step; }

material::Snow light_snow() {
  material::Snow snow;
  snow.density = 120;
  snow.youngs_modulus = 3e5;
  return snow;
}

/// The small scene with a light layer below the scene's own snow in every event, and another layer
/// of the own snow in the second event.
scene::Scene layered_scene(methods::mpm::Transfer transfer = methods::mpm::Transfer::flip) {
  scene::Scene scene = small_scene(transfer);
  scene.slab->thickness = 0;
  scene.slab->layers = {{0.01, light_snow(), 0}, {0.02, {}, 0}, {0.01, {}, 2}};
  return scene;
}

/// Total mass by event and material_id.
std::map<std::pair<int, int>, double> masses(const Simulation& sim) {
  const methods::ParticleState s = sim.method().state();
  std::map<std::pair<int, int>, double> sums;
  for (std::size_t i = 0; i < s.masses.size(); ++i)
    sums[{s.events[i], s.material_ids[i]}] += s.masses[i];
  return sums;
}

class Layers : public io::TemporaryFolder {};

TEST_F(Layers, EachLayerIsAddedInItsEvent) {
  const auto sim = run_all(layered_scene());
  const std::map<std::pair<int, int>, double> expected = {
      {{1, 0}, 0.1 * 0.01 * 120}, {{1, 1}, 0.1 * 0.02 * 210}, {{2, 0}, 0.1 * 0.01 * 120},
      {{2, 1}, 0.1 * 0.03 * 210}, {{3, 0}, 0.1 * 0.01 * 120}, {{3, 1}, 0.1 * 0.02 * 210}};
  const auto measured = masses(*sim);
  ASSERT_EQ(measured.size(), expected.size());
  for (const auto& [key, mass] : expected) EXPECT_NEAR(measured.at(key), mass, 1e-6);
}

TEST_F(Layers, LieInTheGivenOrder) {
  Simulation sim(layered_scene());
  sim.begin_event();
  const methods::ParticleState s = sim.method().state();
  const scene::PanelFrame frame = scene::panel_frame(sim.scene());
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    const double above = frame.normal.dot(s.positions[i] - frame.center);
    EXPECT_EQ(s.material_ids[i], above < 0.01 ? 0 : 1) << above;
    EXPECT_NEAR(s.densities[i], s.material_ids[i] == 0 ? 120 : 210, 1e-3);
  }
}

TEST_F(Layers, WithTheScenesSnowNeedNoMaterialIds) {
  scene::Scene scene = layered_scene();
  scene.slab->layers[0].snow = scene.snow;
  Simulation sim(scene);
  sim.begin_event();
  EXPECT_TRUE(sim.method().state().material_ids.empty());
  EXPECT_EQ(sim.snows().size(), 1u);
}

TEST_F(Layers, ResumingDoesNotChangeTheBits) {
  for (methods::Between between : {methods::Between::carry, methods::Between::reseed}) {
    scene::Scene scene = layered_scene(methods::mpm::Transfer::apic);
    scene.events.between = between;
    const auto resumed = with_interruptions(scene, 1, path("checkpoint"));
    expect_same_bits(*resumed, *run_all(scene));
  }
}

TEST_F(Layers, ThreadsDoNotChangeTheBits) {
  scene::Scene scene = layered_scene();
  scene.events.count = 2;
  const auto single = run_all(scene);
  scene.numerics.as<methods::mpm::Settings>().threads = 2;
  expect_same_bits(*run_all(scene), *single);
}

TEST_F(Layers, KeepTheirMassWhenTheStackIsReseeded) {
  scene::Scene scene = layered_scene();
  scene.events.between = methods::Between::reseed;
  Simulation sim(scene);
  sim.begin_event();
  sim.run(keep_running, never);
  const auto before = masses(sim);
  sim.begin_event();
  const auto after = masses(sim);
  for (const int material_id : {0, 1})
    EXPECT_NEAR(after.at({1, material_id}), before.at({1, material_id}),
                1e-5 * before.at({1, material_id}));
}

TEST_F(Layers, TheStiffestSnowDeterminesTheEstimatedStep) {
  scene::Scene scene = layered_scene(), stiff = layered_scene();
  stiff.slab->layers[0].snow->youngs_modulus = 1e7;
  EXPECT_DOUBLE_EQ(estimated_time_step(scene), estimated_time_step(small_scene()));
  EXPECT_LT(estimated_time_step(stiff), 0.3 * estimated_time_step(scene));
  const CostReport p = report_cost(scene);
  EXPECT_NE(std::find(p.used.begin(), p.used.end(), "several snows"), p.used.end());
  EXPECT_NEAR(p.cost.particles[1] / p.cost.particles[0], 4.0 / 3.0, 0.02);
}

TEST_F(Layers, UnknownSnowInACheckpointIsRefused) {
  Simulation sim(layered_scene());
  sim.begin_event();
  sim.save(path("good"));
  const io::BinaryReader in = io::BinaryReader::load(path("good"));
  const auto material_ids = in.view<std::uint8_t>("particles/kind");
  const std::string bytes = content(path("good"));
  const std::string block(reinterpret_cast<const char*>(material_ids.data), material_ids.size);
  write_plainly(path("forged"), io::forged(bytes, bytes.find(block), std::uint8_t(2)));
  EXPECT_THROW(Simulation::load(path("forged")), InputError);
}

// --- snow that stays on the panel ---------------------------------------------------------------

/// Slabs of a single layer, whose thickness differs from event to event. Friction holds them on the
/// panel.
scene::Scene rough_scene(const std::vector<double>& thicknesses) {
  scene::Scene scene = small_scene();
  scene.panel->friction = 2;
  scene.panel->tilt = 30;
  scene.slab->thickness = 0;
  scene.events.count = int(thicknesses.size());
  for (int event = 1; event <= scene.events.count; ++event)
    if (const double thickness = thicknesses[std::size_t(event - 1)]; thickness > 0)
      scene.slab->layers.push_back({thickness, {}, event});
  return scene;
}

struct Heights {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

Heights heights_of_event(const Simulation& sim, int event) {
  const methods::ParticleState s = sim.method().state();
  const scene::PanelFrame frame = scene::panel_frame(sim.scene());
  Heights h;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    if (s.events[i] != event) continue;
    const double above = frame.normal.dot(s.positions[i] - frame.center);
    h.low = std::min(h.low, above);
    h.high = std::max(h.high, above);
  }
  return h;
}

TEST(PanelSnow, LiesOnSnowThatStayed) {
  Simulation sim(rough_scene({0.03, 0.01, 0.04}));
  double top = 0;
  for (int event = 1; event <= 3; ++event) {
    sim.begin_event();
    const Heights laid = heights_of_event(sim, event);
    EXPECT_GT(laid.low, top);
    EXPECT_LT(laid.low, top + 0.01);  // nor far above
    sim.run(keep_running, never);
    top = std::max(top, heights_of_event(sim, event).high);
  }
  const std::vector<bool> on_panel = sim.on_panel(sim.method().state().positions);
  EXPECT_GT(std::count(on_panel.begin(), on_panel.end(), true), 0.97 * double(on_panel.size()));
}

TEST(PanelSnow, MayStayDuringAnEventWithoutNewSnow) {
  Simulation sim(rough_scene({0.03, 0, 0.03}));
  sim.begin_event();
  sim.run(keep_running, never);
  const std::size_t particles = sim.method().size();
  sim.begin_event();
  EXPECT_EQ(sim.method().size(), particles);
  EXPECT_EQ(sim.run(keep_running, never), RunEnd::rest);
  sim.begin_event();
  EXPECT_EQ(sim.method().size(), 2 * particles);
  EXPECT_GT(heights_of_event(sim, 3).low, heights_of_event(sim, 1).high);
}

TEST(PanelSnow, IncludesBodiesWithoutASlab) {
  scene::Scene scene = rough_scene({0.05});
  const scene::BodySpec body = scene::slab_bodies(scene, 1).front();
  scene.slab.reset();
  scene.bodies = {body};
  Simulation sim(scene);
  sim.begin_event();
  for (const bool on_panel : sim.on_panel(sim.method().state().positions)) EXPECT_TRUE(on_panel);
}

}  // namespace
}  // namespace snowshed::run
