#include "snowshed/scene/assemble.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/scene/scene_json.hpp"
#include "snowshed/support/error.hpp"

namespace snowshed {
namespace {

double radians(double degrees) { return degrees * (3.14159265358979323846 / 180.0); }

double ground_tilt(const Scene& scene) { return scene.ground ? scene.ground->tilt : 0.0; }

/// Outward normal of a plane tilted down in the slide direction.
Vec3 tilted_normal(double tilt) { return {std::sin(radians(tilt)), 0.0, std::cos(radians(tilt))}; }

Vec3 tilted_slope(double tilt) { return {std::cos(radians(tilt)), 0.0, -std::sin(radians(tilt))}; }

ObstacleSpec ground_obstacle(const Ground& ground) {
  ObstacleSpec obstacle;
  obstacle.name = "ground";
  obstacle.shape.type = "plane";
  obstacle.shape.normal = tilted_normal(ground.tilt);
  obstacle.condition = ground.condition;
  obstacle.friction = ground.friction;
  return obstacle;
}

ObstacleSpec panel_obstacle(const Scene& scene) {
  const Panel& panel = *scene.panel;
  const PanelFrame frame = panel_frame(scene);
  // The grid cannot see a board thinner than a few cells: snow would pass through it, or be
  // felt from the other side. The face stays where it is; the board grows downward.
  constexpr double least_cells = 3.0;
  ObstacleSpec obstacle;
  obstacle.name = "panel";
  obstacle.shape.type = "plate";
  obstacle.shape.center = frame.center;
  obstacle.shape.normal = frame.normal;
  obstacle.shape.length = frame.length;
  obstacle.shape.width = frame.width;
  obstacle.shape.thickness = std::max(panel.thickness, least_cells * scene.numerics.dx);
  obstacle.condition = panel.condition;
  obstacle.friction = panel.friction;
  return obstacle;
}

BodySpec slab_body(const Scene& scene, double lift) {
  const Slab& slab = *scene.slab;
  const PanelFrame frame = panel_frame(scene);
  ShapeSpec box;
  box.type = "box";
  box.size = {slab.length, scene.dimension == 3 ? slab.width : 0.0, slab.thickness};
  BodySpec body;
  body.event = 0;
  body.shape.type = "transform";
  body.shape.shapes = {box};
  body.shape.axis = Vec3::UnitY();
  body.shape.angle = scene.panel->tilt;
  body.shape.translate = frame.center + (lift + slab.thickness / 2.0) * frame.normal;
  return body;
}

}  // namespace

PanelFrame panel_frame(const Scene& scene) {
  if (!scene.panel) throw InputError("/", "the scene has no panel");
  const Panel& panel = *scene.panel;
  PanelFrame frame;
  frame.center = Vec3::Zero();
  frame.normal = tilted_normal(panel.tilt);
  frame.slope = tilted_slope(panel.tilt);
  frame.length = panel.length;
  frame.width = panel.width;
  frame.center.z() = panel.height - height_above_ground(scene, frame.lower_edge());
  return frame;
}

double height_above_ground(const Scene& scene, const Vec3& point) {
  return point.z() + point.x() * std::tan(radians(ground_tilt(scene)));
}

std::vector<ObstacleSpec> assemble_obstacles(const Scene& scene) {
  std::vector<ObstacleSpec> obstacles;
  if (scene.ground) obstacles.push_back(ground_obstacle(*scene.ground));
  if (scene.panel) obstacles.push_back(panel_obstacle(scene));
  obstacles.insert(obstacles.end(), scene.obstacles.begin(), scene.obstacles.end());
  return obstacles;
}

std::vector<BodySpec> assemble_bodies(const Scene& scene, int event, double lift) {
  std::vector<BodySpec> bodies;
  if (scene.slab) bodies.push_back(slab_body(resolve(scene), lift));
  for (const auto& body : scene.bodies)
    if (body.event == 0 || body.event == event) bodies.push_back(body);
  return bodies;
}

}  // namespace snowshed
