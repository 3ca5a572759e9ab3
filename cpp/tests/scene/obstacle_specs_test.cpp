#include "snowshed/scene/obstacle_specs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/panel_scene.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/scene/panel_frame.hpp"

namespace snowshed::scene {
namespace {

TEST(ObstacleSpecs, ASceneWithoutGroundHasNoGroundObstacle) {
  Scene scene = panel_scene(30.0);
  scene.ground.reset();
  EXPECT_EQ(obstacle_specs(scene).size(), 1u);
}

TEST(ObstacleSpecs, GroundPassesThroughTheOriginAndFallsDownhill) {
  Scene scene = panel_scene(30.0, 20.0);
  scene.ground->condition = methods::Condition::slip;
  scene.ground->friction = 0.7;
  const ObstacleSpec ground = obstacle_specs(scene).at(0);
  EXPECT_EQ(ground.name, "ground");
  EXPECT_EQ(ground.shape.type, "plane");
  EXPECT_EQ(ground.shape.center, Vec3::Zero());
  EXPECT_TRUE(
      ground.shape.normal.isApprox(Vec3(std::sin(radians(20)), 0, std::cos(radians(20))), 1e-14));
  EXPECT_EQ(ground.condition, methods::Condition::slip);
  EXPECT_EQ(ground.friction, 0.7);
}

TEST(ObstacleSpecs, PanelIsAPlateBelowItsFace) {
  Scene scene = panel_scene(40.0);
  scene.panel->friction = 0.25;
  const ObstacleSpec panel = obstacle_specs(scene).at(1);
  const PanelFrame frame = panel_frame(scene);
  EXPECT_EQ(panel.name, "panel");
  EXPECT_EQ(panel.shape.type, "plate");
  EXPECT_EQ(panel.shape.center, frame.center);
  EXPECT_EQ(panel.shape.normal, frame.normal);
  EXPECT_EQ(panel.shape.length, 2.0);
  EXPECT_EQ(panel.shape.width, 3.0);
  EXPECT_EQ(panel.condition, methods::Condition::separate);
  EXPECT_EQ(panel.friction, 0.25);
}

TEST(ObstacleSpecs, ContactThicknessIsAtLeastThreeCellsAndLeavesTheFace) {
  Scene scene = panel_scene(40.0);
  scene.panel->thickness = 0.02;
  EXPECT_DOUBLE_EQ(obstacle_specs(scene).at(1).shape.thickness, 0.03);
  EXPECT_EQ(obstacle_specs(scene).at(1).shape.center, panel_frame(scene).center);
  scene.panel->thickness = 0.05;
  EXPECT_DOUBLE_EQ(obstacle_specs(scene).at(1).shape.thickness, 0.05);
}

TEST(ObstacleSpecs, ObstaclesOfTheSceneFollow) {
  Scene scene = panel_scene(40.0);
  scene.obstacles.emplace_back().name = "post";
  const auto obstacles = obstacle_specs(scene);
  ASSERT_EQ(obstacles.size(), 3u);
  EXPECT_EQ(obstacles[2].name, "post");
}

}  // namespace
}  // namespace snowshed::scene
