// Slabs of several layers, and snow laid on what stayed on the panel.
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
#include "snowshed/scene/assemble.hpp"

namespace snowshed {
namespace {

/// The first time step of a scene at rest, s.
double first_time_step(const Scene& scene) { return estimate_cost(scene).time_step; }

Snow light_snow() {
  Snow snow;
  snow.density = 120;
  snow.youngs_modulus = 3e5;
  return snow;
}

/// The small scene with a light layer below the scene's own snow in every event, and another layer
/// of the own snow in the second event.
Scene layered_scene(mpm::Transfer transfer = mpm::Transfer::flip) {
  Scene scene = small_scene(transfer);
  scene.slab->thickness = 0;
  scene.slab->layers = {{0.01, light_snow(), 0}, {0.02, {}, 0}, {0.01, {}, 2}};
  return scene;
}

/// Total mass by event and material_id.
std::map<std::pair<int, int>, double> masses(const Simulation& sim) {
  const ParticleState s = sim.method().state();
  std::map<std::pair<int, int>, double> sums;
  for (std::size_t i = 0; i < s.masses.size(); ++i)
    sums[{s.events[i], s.material_ids[i]}] += s.masses[i];
  return sums;
}

class Layers : public TemporaryFolder {};

TEST_F(Layers, BringTheirOwnSnowInTheirEvents) {
  const auto sim = run_all(layered_scene());
  const std::map<std::pair<int, int>, double> expected = {
      {{1, 0}, 0.1 * 0.01 * 120}, {{1, 1}, 0.1 * 0.02 * 210}, {{2, 0}, 0.1 * 0.01 * 120},
      {{2, 1}, 0.1 * 0.03 * 210}, {{3, 0}, 0.1 * 0.01 * 120}, {{3, 1}, 0.1 * 0.02 * 210}};
  const auto found = masses(*sim);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [key, mass] : expected) EXPECT_NEAR(found.at(key), mass, 1e-6);
}

TEST_F(Layers, LieOnEachOtherInTheOrderGiven) {
  Simulation sim(layered_scene());
  sim.begin_event();
  const ParticleState s = sim.method().state();
  const PanelFrame frame = panel_frame(sim.scene());
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    const double above = frame.normal.dot(s.positions[i] - frame.center);
    EXPECT_EQ(s.material_ids[i], above < 0.01 ? 0 : 1) << above;
    EXPECT_NEAR(s.densities[i], s.material_ids[i] == 0 ? 120 : 210, 1e-3);
  }
}

TEST_F(Layers, OfTheScenesOwnSnowNeedNoMaterialIds) {
  Scene scene = layered_scene();
  scene.slab->layers[0].snow = scene.snow;
  Simulation sim(scene);
  sim.begin_event();
  EXPECT_TRUE(sim.method().state().material_ids.empty());
  EXPECT_EQ(sim.snows().size(), 1u);
}

TEST_F(Layers, AResumedRunEqualsAnUninterruptedOneBitForBit) {
  for (Between between : {Between::carry, Between::reseed}) {
    Scene scene = layered_scene(mpm::Transfer::apic);
    scene.events.between = between;
    const auto resumed = with_interruptions(scene, 1, path("checkpoint"));
    expect_same_bits(*resumed, *run_all(scene));
  }
}

TEST_F(Layers, OfTwoThreadsHaveTheSameBits) {
  Scene scene = layered_scene();
  scene.events.count = 2;
  const auto one = run_all(scene);
  scene.numerics.as<mpm::Settings>().threads = 2;
  expect_same_bits(*run_all(scene), *one);
}

TEST_F(Layers, KeepTheirMassWhenTheStackIsReseeded) {
  Scene scene = layered_scene();
  scene.events.between = Between::reseed;
  Simulation sim(scene);
  sim.begin_event();
  sim.run(go_on, never);
  const auto before = masses(sim);
  sim.begin_event();
  const auto after = masses(sim);
  for (const int material_id : {0, 1})
    EXPECT_NEAR(after.at({1, material_id}), before.at({1, material_id}),
                1e-5 * before.at({1, material_id}));
}

TEST_F(Layers, StiffestSnowDecidesTheEstimatedStep) {
  Scene scene = layered_scene(), stiff = layered_scene();
  stiff.slab->layers[0].snow->youngs_modulus = 1e7;
  EXPECT_DOUBLE_EQ(first_time_step(scene), first_time_step(small_scene()));
  EXPECT_LT(first_time_step(stiff), 0.3 * first_time_step(scene));
  const CostReport p = report_cost(scene);
  EXPECT_NE(std::find(p.used.begin(), p.used.end(), "several snows"), p.used.end());
  EXPECT_NEAR(p.cost.particles[1] / p.cost.particles[0], 4.0 / 3.0, 0.02);
}

TEST_F(Layers, OfAnUnknownSnowAreRefusedInACheckpoint) {
  Simulation sim(layered_scene());
  sim.begin_event();
  sim.save(path("good"));
  const BinaryReader in = BinaryReader::load(path("good"));
  const auto material_ids = in.view<std::uint8_t>("particles/kind");
  const std::string bytes = content(path("good"));
  const std::string block(reinterpret_cast<const char*>(material_ids.data), material_ids.size);
  write_plainly(path("forged"), forged(bytes, bytes.find(block), std::uint8_t(2)));
  EXPECT_THROW(Simulation::load(path("forged")), InputError);
}

// --- snow that stays on the panel ---------------------------------------------------------------

/// Slabs of a single layer, whose thickness differs from event to event. Friction holds them on the
/// panel.
Scene rough_scene(const std::vector<double>& thicknesses) {
  Scene scene = small_scene();
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
  const ParticleState s = sim.method().state();
  const PanelFrame frame = panel_frame(sim.scene());
  Heights h;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    if (s.events[i] != event) continue;
    const double above = frame.normal.dot(s.positions[i] - frame.center);
    h.low = std::min(h.low, above);
    h.high = std::max(h.high, above);
  }
  return h;
}

TEST(PanelSnow, LiesOnWhatStayedThere) {
  Simulation sim(rough_scene({0.03, 0.01, 0.04}));
  double top = 0;
  for (int event = 1; event <= 3; ++event) {
    sim.begin_event();
    const Heights laid = heights_of_event(sim, event);
    EXPECT_GT(laid.low, top);
    EXPECT_LT(laid.low, top + 0.01);  // not far above, either
    sim.run(go_on, never);
    top = std::max(top, heights_of_event(sim, event).high);
  }
  const std::vector<bool> there = sim.on_panel(sim.method().state().positions);
  EXPECT_GT(std::count(there.begin(), there.end(), true), 0.97 * double(there.size()));
}

TEST(PanelSnow, MayStayThroughAnEventWithoutNewSnow) {
  Simulation sim(rough_scene({0.03, 0, 0.03}));
  sim.begin_event();
  sim.run(go_on, never);
  const std::size_t particles = sim.method().size();
  sim.begin_event();
  EXPECT_EQ(sim.method().size(), particles);
  EXPECT_EQ(sim.run(go_on, never), RunEnd::rest);
  sim.begin_event();
  EXPECT_EQ(sim.method().size(), 2 * particles);
  EXPECT_GT(heights_of_event(sim, 3).low, heights_of_event(sim, 1).high);
}

TEST(PanelSnow, OfABodyIsSeenWithoutASlab) {
  Scene scene = rough_scene({0.05});
  const BodySpec body = assemble_slab(scene, 1).front();
  scene.slab.reset();
  scene.bodies = {body};
  Simulation sim(scene);
  sim.begin_event();
  for (const bool there : sim.on_panel(sim.method().state().positions)) EXPECT_TRUE(there);
}

}  // namespace
}  // namespace snowshed
