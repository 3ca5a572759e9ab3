#include "snowshed/run/panel_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "run/simulation_testing.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

/// The panel of the small scene is 0.1 m long. Snow 0.03 m thick was laid on it; the cells are 0.01
/// m.
struct Place {
  double along, above;
  bool on_panel;
};

TEST(PanelRegion, ReachesFromTheFaceToWhatCouldLieThereAndNoFurtherThanTheEdges) {
  const Scene scene = resolve(small_scene());
  const PanelFrame frame = panel_frame(scene);
  for (const Place& place :
       {Place{0, 0.01, true}, Place{0, 0.045, true}, Place{0, 0.055, false}, Place{0, -0.005, true},
        Place{0, -0.015, false}, Place{0.049, 0.01, true}, Place{0.051, 0.01, false},
        Place{-0.049, 0.01, true}, Place{-0.051, 0.01, false}}) {
    const Vec3 x = frame.center + place.along * frame.slope + place.above * frame.normal;
    EXPECT_EQ(PanelRegion(scene).contains({x}, 0.03).at(0), place.on_panel)
        << place.along << " " << place.above;
  }
}

TEST(PanelSnow, OfOneStrayGrainDoesNotLiftTheNextSlab) {
  Scene scene = small_scene();
  scene.panel->height = 0.4;  // so that all slides off
  scene.events.max_time = 1;
  Simulation sim(scene);
  sim.begin_event();
  sim.run(go_on, never);
  const PanelFrame frame = panel_frame(sim.scene());
  const std::vector<bool> there = sim.on_panel(sim.method().state().positions);
  ASSERT_EQ(std::count(there.begin(), there.end(), true), 0);
  ParticleBatch grain;
  grain.positions = {frame.center + 0.01 * frame.normal};
  grain.mass = 1e-3;
  sim.add_snow(grain);
  const std::size_t before = sim.method().size();
  sim.begin_event();
  const ParticleState s = sim.method().state();
  double lowest = 1;
  for (std::size_t i = before; i < s.positions.size(); ++i)
    lowest = std::min(lowest, frame.normal.dot(s.positions[i] - frame.center));
  EXPECT_LT(lowest, 0.01);
}

}  // namespace
}  // namespace snowshed
