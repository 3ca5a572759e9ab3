#include "snowshed/scene/assemble.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed {
namespace {

Scene panel_scene(double tilt, double ground_tilt = 0.0) {
  Scene scene;
  Panel& panel = scene.panel.emplace();
  panel.height = 0.5;
  panel.length = 2.0;
  panel.width = 3.0;
  panel.tilt = tilt;
  scene.slab.emplace().thickness = 0.1;
  scene.ground.emplace().tilt = ground_tilt;
  scene.numerics.as<MpmSettings>().dx = 0.01;
  return scene;
}

/// Corner of a slab: signs pick the end along the slope, across, and the upper side.
Vec3 corner(const ShapeSpec& slab, double along, double across, double up) {
  EXPECT_EQ(slab.type, "transform");
  const Vec3 half = slab.shapes.at(0).size / 2.0;
  const Mat3 rotation = Eigen::AngleAxisd(radians(slab.angle), slab.axis).toRotationMatrix();
  return rotation * Vec3(along * half.x(), across * half.y(), up * half.z()) + slab.translate;
}

TEST(Assemble, LowerEdgeStandsAboveALevelGround) {
  const PanelFrame frame = panel_frame(panel_scene(30.0));
  EXPECT_TRUE(frame.normal.isApprox(Vec3(0.5, 0, std::sqrt(3) / 2), 1e-14));
  EXPECT_TRUE(frame.slope.isApprox(Vec3(std::sqrt(3) / 2, 0, -0.5), 1e-14));
  EXPECT_TRUE(frame.center.isApprox(Vec3(0, 0, 1.0), 1e-14));  // 0.5 + 1 sin 30
  EXPECT_TRUE(frame.lower_edge().isApprox(Vec3(std::sqrt(3) / 2, 0, 0.5), 1e-14));
  EXPECT_TRUE(frame.upper_edge().isApprox(Vec3(-std::sqrt(3) / 2, 0, 1.5), 1e-14));
  EXPECT_EQ(frame.length, 2.0);
  EXPECT_EQ(frame.width, 3.0);
}

TEST(Assemble, LowerEdgeStandsVerticallyAboveATiltedGround) {
  // The ground falls in +x, so below the edge at x = cos 30 it lies at z = -x tan 45 = -x.
  const Scene scene = panel_scene(30.0, 45.0);
  const PanelFrame frame = panel_frame(scene);
  EXPECT_NEAR(frame.center.x(), 0.0, 1e-15);
  EXPECT_NEAR(frame.center.z(), 1.0 - std::sqrt(3) / 2, 1e-14);
  EXPECT_NEAR(height_above_ground(scene, frame.lower_edge()), 0.5, 1e-14);
  EXPECT_NEAR(frame.lower_edge().z() + frame.lower_edge().x(), 0.5, 1e-14);
}

TEST(Assemble, HeightIsMeasuredFromZeroWithoutGround) {
  Scene scene = panel_scene(30.0, 45.0);
  scene.ground.reset();
  EXPECT_NEAR(panel_frame(scene).lower_edge().z(), 0.5, 1e-14);
  EXPECT_EQ(assemble_obstacles(scene).size(), 1u);
}

TEST(Assemble, GroundPassesThroughTheOriginAndFallsDownhill) {
  Scene scene = panel_scene(30.0, 20.0);
  scene.ground->condition = Condition::slip;
  scene.ground->friction = 0.7;
  const ObstacleSpec ground = assemble_obstacles(scene).at(0);
  EXPECT_EQ(ground.name, "ground");
  EXPECT_EQ(ground.shape.type, "plane");
  EXPECT_EQ(ground.shape.center, Vec3::Zero());
  EXPECT_TRUE(
      ground.shape.normal.isApprox(Vec3(std::sin(radians(20)), 0, std::cos(radians(20))), 1e-14));
  EXPECT_EQ(ground.condition, Condition::slip);
  EXPECT_EQ(ground.friction, 0.7);
}

TEST(Assemble, PanelIsAPlateBelowItsFace) {
  Scene scene = panel_scene(40.0);
  scene.panel->friction = 0.25;
  const ObstacleSpec panel = assemble_obstacles(scene).at(1);
  const PanelFrame frame = panel_frame(scene);
  EXPECT_EQ(panel.name, "panel");
  EXPECT_EQ(panel.shape.type, "plate");
  EXPECT_EQ(panel.shape.center, frame.center);
  EXPECT_EQ(panel.shape.normal, frame.normal);
  EXPECT_EQ(panel.shape.length, 2.0);
  EXPECT_EQ(panel.shape.width, 3.0);
  EXPECT_EQ(panel.condition, Condition::separate);
  EXPECT_EQ(panel.friction, 0.25);
}

TEST(Assemble, ContactThicknessIsAtLeastThreeCellsAndLeavesTheFace) {
  Scene scene = panel_scene(40.0);
  scene.panel->thickness = 0.02;
  EXPECT_DOUBLE_EQ(assemble_obstacles(scene).at(1).shape.thickness, 0.03);
  EXPECT_EQ(assemble_obstacles(scene).at(1).shape.center, panel_frame(scene).center);
  scene.panel->thickness = 0.05;
  EXPECT_DOUBLE_EQ(assemble_obstacles(scene).at(1).shape.thickness, 0.05);
}

TEST(Assemble, OwnObstaclesFollow) {
  Scene scene = panel_scene(40.0);
  scene.obstacles.emplace_back().name = "post";
  const auto obstacles = assemble_obstacles(scene);
  ASSERT_EQ(obstacles.size(), 3u);
  EXPECT_EQ(obstacles[2].name, "post");
}

TEST(Assemble, SlabLiesCentredOnThePanel) {
  Scene scene = panel_scene(30.0, 10.0);
  scene.slab->length = 1.0;
  const PanelFrame frame = panel_frame(scene);
  const ShapeSpec slab = assemble_bodies(scene, 1).at(0).shape;
  EXPECT_EQ(slab.shapes.at(0).size, Vec3(1.0, 2.0, 0.1));  // two thirds of the width
  for (const double along : {-1.0, 1.0})
    for (const double across : {-1.0, 1.0}) {
      const Vec3 foot = corner(slab, along, across, -1.0) - frame.center;
      EXPECT_NEAR(foot.dot(frame.normal), 0.0, 1e-14);
      EXPECT_NEAR(foot.dot(frame.slope), along * 0.5, 1e-14);
      EXPECT_NEAR(foot.y(), across * 1.0, 1e-14);
      const Vec3 top = corner(slab, along, across, 1.0) - frame.center;
      EXPECT_NEAR(top.dot(frame.normal), 0.1, 1e-14);
    }
}

TEST(Assemble, LiftMovesTheSlabAlongTheNormal) {
  const Scene scene = panel_scene(35.0);
  const ShapeSpec low = assemble_bodies(scene, 1).at(0).shape;
  const ShapeSpec high = assemble_bodies(scene, 2, 0.25).at(0).shape;
  EXPECT_TRUE((high.translate - low.translate).isApprox(0.25 * panel_frame(scene).normal, 1e-14));
  EXPECT_EQ(high.angle, low.angle);
}

TEST(Assemble, PlaneSlabsHaveNoWidth) {
  Scene scene = panel_scene(35.0);
  scene.dimension = 2;
  EXPECT_EQ(assemble_bodies(scene, 1).at(0).shape.shapes.at(0).size, Vec3(2.0, 0.0, 0.1));
}

TEST(Assemble, BodiesAppearInTheirEvent) {
  Scene scene = panel_scene(35.0);
  for (const int event : {0, 1, 3}) {
    BodySpec& body = scene.bodies.emplace_back();
    body.event = event;
    body.shape.radius = event;
  }
  const auto radii = [&](int event) {
    std::vector<double> radii;
    const auto bodies = assemble_bodies(scene, event, 0.5);
    for (std::size_t i = 1; i < bodies.size(); ++i) radii.push_back(bodies[i].shape.radius);
    return radii;
  };
  EXPECT_EQ(radii(1), (std::vector<double>{0, 1}));
  EXPECT_EQ(radii(2), (std::vector<double>{0}));
  EXPECT_EQ(radii(3), (std::vector<double>{0, 3}));
  EXPECT_EQ(assemble_bodies(scene, 2).at(0).event, 0);
}

TEST(Assemble, WithoutPanelThereIsNoFrame) { EXPECT_THROW(panel_frame(Scene{}), InputError); }

}  // namespace
}  // namespace snowshed
