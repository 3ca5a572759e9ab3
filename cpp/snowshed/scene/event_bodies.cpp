#include "snowshed/scene/event_bodies.hpp"

#include "snowshed/scene/panel_frame.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::scene {
namespace {

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

}  // namespace

std::vector<Layer> layers_of(const Slab& slab) {
  return slab.layers.empty() ? std::vector<Layer>{{slab.thickness, std::nullopt, 0}} : slab.layers;
}

std::vector<BodySpec> slab_bodies(const Scene& scene, int event, double lift) {
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

std::vector<BodySpec> event_bodies(const Scene& scene, int event, double lift) {
  std::vector<BodySpec> bodies = slab_bodies(scene, event, lift);
  for (const auto& body : scene.bodies)
    if (is_added_in(body, event)) bodies.push_back(body);
  return bodies;
}

}  // namespace snowshed::scene
