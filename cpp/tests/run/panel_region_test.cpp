#include "snowshed/run/panel_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "run/simulation_testing.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

/// The panel of the small scene is 0.1 m long. Snow 0.03 m thick was laid on it; the cells are 0.01
/// m.
struct PanelPosition {
  double along, above;
  bool on_panel;
};

TEST(PanelRegion, CoversTheFaceWithinItsEdgesUpToTheLaidHeight) {
  const scene::Scene scene = scene::resolve(small_scene());
  const scene::PanelFrame frame = scene::panel_frame(scene);
  for (const PanelPosition& position :
       {PanelPosition{0, 0.01, true}, PanelPosition{0, 0.045, true}, PanelPosition{0, 0.055, false},
        PanelPosition{0, -0.005, true}, PanelPosition{0, -0.015, false},
        PanelPosition{0.049, 0.01, true}, PanelPosition{0.051, 0.01, false},
        PanelPosition{-0.049, 0.01, true}, PanelPosition{-0.051, 0.01, false}}) {
    const Vec3 x = frame.center + position.along * frame.slope + position.above * frame.normal;
    EXPECT_EQ(PanelRegion(scene).contains({x}, 0.03).at(0), position.on_panel)
        << position.along << " " << position.above;
  }
}

TEST(PanelSnow, IsNotLiftedByAStrayGrain) {
  scene::Scene scene = small_scene();
  scene.panel->height = 0.4;  // so that all snow slides off
  scene.events.max_time = 1;
  Simulation sim(scene);
  sim.begin_event();
  sim.run(keep_running, never);
  const scene::PanelFrame frame = scene::panel_frame(sim.scene());
  const std::vector<bool> on_panel = sim.on_panel(sim.method().state().positions);
  ASSERT_EQ(std::count(on_panel.begin(), on_panel.end(), true), 0);
  methods::ParticleBatch grain;
  grain.positions = {frame.center + 0.01 * frame.normal};
  grain.mass = 1e-3;
  sim.add_snow(grain);
  const std::size_t before = sim.method().size();
  sim.begin_event();
  const methods::ParticleState s = sim.method().state();
  double min_height = 1;
  for (std::size_t i = before; i < s.positions.size(); ++i)
    min_height = std::min(min_height, frame.normal.dot(s.positions[i] - frame.center));
  EXPECT_LT(min_height, 0.01);
}

}  // namespace
}  // namespace snowshed::run
