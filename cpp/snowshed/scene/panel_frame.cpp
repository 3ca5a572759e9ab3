#include "snowshed/scene/panel_frame.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::scene {
namespace {

double ground_tilt(const Scene& scene) { return scene.ground ? scene.ground->tilt : 0.0; }

Vec3 tilted_slope(double tilt) { return {std::cos(radians(tilt)), 0.0, -std::sin(radians(tilt))}; }

}  // namespace

Vec3 tilted_normal(double tilt) { return {std::sin(radians(tilt)), 0.0, std::cos(radians(tilt))}; }

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
  frame.board_thickness = std::max(panel.thickness, min_cells * scene.numerics->resolution());
  frame.center.z() = panel.height - height_above_ground(scene, frame.lower_edge());
  return frame;
}

double height_above_ground(const Scene& scene, const Vec3& point) {
  return point.z() + point.x() * std::tan(radians(ground_tilt(scene)));
}

}  // namespace snowshed::scene
