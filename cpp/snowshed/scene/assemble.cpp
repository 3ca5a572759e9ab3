#include "snowshed/scene/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

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
  ObstacleSpec obstacle;
  obstacle.name = "panel";
  obstacle.shape.type = "plate";
  obstacle.shape.center = frame.center;
  obstacle.shape.normal = frame.normal;
  obstacle.shape.length = frame.length;
  obstacle.shape.width = frame.width;
  obstacle.shape.thickness = frame.board;
  obstacle.condition = panel.condition;
  obstacle.friction = panel.friction;
  return obstacle;
}

/// A layer of the slab whose underside is `height` above the panel.
BodySpec layer_body(const Scene& scene, const Layer& layer, double height) {
  const Slab& slab = *scene.slab;
  const PanelFrame frame = panel_frame(scene);
  ShapeSpec box;
  box.type = "box";
  box.size = {slab.length, scene.dimension == 3 ? slab.width : 0.0, layer.thickness};
  BodySpec body;
  body.event = layer.event;
  body.snow = layer.snow;
  body.shape.type = "transform";
  body.shape.shapes = {box};
  body.shape.axis = Vec3::UnitY();
  body.shape.angle = scene.panel->tilt;
  body.shape.translate = frame.center + (height + layer.thickness / 2.0) * frame.normal;
  return body;
}

/// The slab's layers; a slab that is given by its thickness has a single layer.
std::vector<Layer> layers_of(const Slab& slab) {
  return slab.layers.empty() ? std::vector<Layer>{{slab.thickness, std::nullopt, 0}} : slab.layers;
}

bool are_same(const Snow& a, const Snow& b) {
  const auto values = [](const Snow& s) {
    return std::tie(s.model, s.density, s.youngs_modulus, s.poissons_ratio, s.critical_state_slope,
                    s.preconsolidation_pressure, s.cohesion, s.hardening_factor);
  };
  return values(a) == values(b);
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
  // The grid does not resolve a board thinner than a few cells: snow would pass through it, or act
  // through it. The face does not move; the board grows downward.
  constexpr double min_cells = 3.0;
  frame.board = std::max(panel.thickness, min_cells * scene.numerics->resolution());
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

std::vector<BodySpec> assemble_slab(const Scene& scene, int event, double lift) {
  std::vector<BodySpec> bodies;
  if (!scene.slab) return bodies;
  const Scene resolved = resolve(scene);
  double height = lift;
  for (const Layer& layer : layers_of(*scene.slab)) {
    if (!is_added_in(layer, event)) continue;
    bodies.push_back(layer_body(resolved, layer, height));
    height += layer.thickness;
  }
  return bodies;
}

double slab_thickness(const Slab& slab, int event) {
  double thickness = 0.0;
  for (const Layer& layer : layers_of(slab))
    if (is_added_in(layer, event)) thickness += layer.thickness;
  return thickness;
}

std::vector<BodySpec> assemble_bodies(const Scene& scene, int event, double lift) {
  std::vector<BodySpec> bodies = assemble_slab(scene, event, lift);
  for (const auto& body : scene.bodies)
    if (is_added_in(body, event)) bodies.push_back(body);
  return bodies;
}

std::vector<Snow> assemble_snows(const Scene& scene) {
  std::vector<Snow> snows;
  const auto meet = [&](const auto& part) {
    const Snow& snow = snow_of(scene, part);
    if (std::none_of(snows.begin(), snows.end(),
                     [&](const Snow& known) { return are_same(known, snow); }))
      snows.push_back(snow);
  };
  if (scene.slab)
    for (const Layer& layer : layers_of(*scene.slab)) meet(layer);
  for (const BodySpec& body : scene.bodies) meet(body);
  return snows;
}

int material_id_of(const Snow& snow, const std::vector<Snow>& snows) {
  const auto same = std::find_if(snows.begin(), snows.end(),
                                 [&](const Snow& known) { return are_same(known, snow); });
  return int(same - snows.begin());
}

}  // namespace snowshed
