#include "snowshed/scene/obstacle_specs.hpp"

#include "snowshed/scene/panel_frame.hpp"

namespace snowshed::scene {
namespace {

ObstacleSpec ground_spec(const Ground& ground) {
  ObstacleSpec obstacle;
  obstacle.name = "ground";
  obstacle.shape.type = "plane";
  obstacle.shape.normal = tilted_normal(ground.tilt);
  obstacle.condition = ground.condition;
  obstacle.friction = ground.friction;
  return obstacle;
}

ObstacleSpec panel_spec(const Scene& scene) {
  const Panel& panel = *scene.panel;
  const PanelFrame frame = panel_frame(scene);
  ObstacleSpec obstacle;
  obstacle.name = "panel";
  obstacle.shape.type = "plate";
  obstacle.shape.center = frame.center;
  obstacle.shape.normal = frame.normal;
  obstacle.shape.length = frame.length;
  obstacle.shape.width = frame.width;
  obstacle.shape.thickness = frame.board_thickness;
  obstacle.condition = panel.condition;
  obstacle.friction = panel.friction;
  return obstacle;
}

}  // namespace

std::vector<ObstacleSpec> obstacle_specs(const Scene& scene) {
  std::vector<ObstacleSpec> specs;
  if (scene.ground) specs.push_back(ground_spec(*scene.ground));
  if (scene.panel) specs.push_back(panel_spec(scene));
  specs.insert(specs.end(), scene.obstacles.begin(), scene.obstacles.end());
  return specs;
}

}  // namespace snowshed::scene
