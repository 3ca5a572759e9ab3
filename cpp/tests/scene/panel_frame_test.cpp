#include "snowshed/scene/panel_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/panel_scene.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::scene {
namespace {

TEST(PanelFrame, LowerEdgeStandsAboveALevelGround) {
  const PanelFrame frame = panel_frame(panel_scene(30.0));
  EXPECT_TRUE(frame.normal.isApprox(Vec3(0.5, 0, std::sqrt(3) / 2), 1e-14));
  EXPECT_TRUE(frame.slope.isApprox(Vec3(std::sqrt(3) / 2, 0, -0.5), 1e-14));
  EXPECT_TRUE(frame.center.isApprox(Vec3(0, 0, 1.0), 1e-14));  // 0.5 + 1 sin 30
  EXPECT_TRUE(frame.lower_edge().isApprox(Vec3(std::sqrt(3) / 2, 0, 0.5), 1e-14));
  EXPECT_TRUE(frame.upper_edge().isApprox(Vec3(-std::sqrt(3) / 2, 0, 1.5), 1e-14));
  EXPECT_EQ(frame.length, 2.0);
  EXPECT_EQ(frame.width, 3.0);
}

TEST(PanelFrame, LowerEdgeStandsVerticallyAboveATiltedGround) {
  // The ground falls in +x, so below the edge at x = cos 30 it lies at z = -x tan 45 = -x.
  const Scene scene = panel_scene(30.0, 45.0);
  const PanelFrame frame = panel_frame(scene);
  EXPECT_NEAR(frame.center.x(), 0.0, 1e-15);
  EXPECT_NEAR(frame.center.z(), 1.0 - std::sqrt(3) / 2, 1e-14);
  EXPECT_NEAR(height_above_ground(scene, frame.lower_edge()), 0.5, 1e-14);
  EXPECT_NEAR(frame.lower_edge().z() + frame.lower_edge().x(), 0.5, 1e-14);
}

TEST(PanelFrame, HeightIsMeasuredFromZeroWithoutGround) {
  Scene scene = panel_scene(30.0, 45.0);
  scene.ground.reset();
  EXPECT_NEAR(panel_frame(scene).lower_edge().z(), 0.5, 1e-14);
}

TEST(PanelFrame, NeedsAPanel) { EXPECT_THROW(panel_frame(Scene{}), InputError); }

}  // namespace
}  // namespace snowshed::scene
