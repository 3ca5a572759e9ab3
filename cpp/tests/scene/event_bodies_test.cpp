#include "snowshed/scene/event_bodies.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "scene/panel_scene.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/scene/panel_frame.hpp"

namespace snowshed::scene {
namespace {

/// Corner of a slab: signs pick the end along the slope, across, and the upper side.
Vec3 corner(const ShapeSpec& slab, double along, double across, double up) {
  EXPECT_EQ(slab.type, "transform");
  const Vec3 half = slab.shapes.at(0).size / 2.0;
  const Mat3 rotation = Eigen::AngleAxisd(radians(slab.angle), slab.axis).toRotationMatrix();
  return rotation * Vec3(along * half.x(), across * half.y(), up * half.z()) + slab.translate;
}

TEST(EventBodies, SlabIsCenteredOnThePanel) {
  Scene scene = panel_scene(30.0, 10.0);
  scene.slab->length = 1.0;
  const PanelFrame frame = panel_frame(scene);
  const ShapeSpec slab = event_bodies(scene, 1).at(0).shape;
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

TEST(EventBodies, LiftMovesTheSlabAlongTheNormal) {
  const Scene scene = panel_scene(35.0);
  const ShapeSpec low = event_bodies(scene, 1).at(0).shape;
  const ShapeSpec high = event_bodies(scene, 2, 0.25).at(0).shape;
  EXPECT_TRUE((high.translate - low.translate).isApprox(0.25 * panel_frame(scene).normal, 1e-14));
  EXPECT_EQ(high.angle, low.angle);
}

TEST(EventBodies, PlaneSlabsHaveNoWidth) {
  Scene scene = panel_scene(35.0);
  scene.dimension = 2;
  EXPECT_EQ(event_bodies(scene, 1).at(0).shape.shapes.at(0).size, Vec3(2.0, 0.0, 0.1));
}

TEST(EventBodies, BodiesAppearInTheirEvent) {
  Scene scene = panel_scene(35.0);
  for (const int event : {0, 1, 3}) {
    BodySpec& body = scene.bodies.emplace_back();
    body.event = event;
    body.shape.radius = event;
  }
  const auto radii = [&](int event) {
    std::vector<double> radii;
    const auto bodies = event_bodies(scene, event, 0.5);
    for (std::size_t i = 1; i < bodies.size(); ++i) radii.push_back(bodies[i].shape.radius);
    return radii;
  };
  EXPECT_EQ(radii(1), (std::vector<double>{0, 1}));
  EXPECT_EQ(radii(2), (std::vector<double>{0}));
  EXPECT_EQ(radii(3), (std::vector<double>{0, 3}));
  EXPECT_EQ(event_bodies(scene, 2).at(0).event, 0);
}

}  // namespace
}  // namespace snowshed::scene
