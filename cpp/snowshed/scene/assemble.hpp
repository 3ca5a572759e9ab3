// Plain obstacles and bodies for the panel, slab and ground of Figure 3.1.1.
//
// x points down the slide direction, y across, z up. The origin of x is the panel's centre.
// The ground passes through the origin with normal (sin psi, 0, cos psi); the panel's face has
// normal (sin phi, 0, cos phi), and its lower edge stands `height` vertically above the ground.
#pragma once

#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// The panel's sliding face.
struct PanelFrame {
  Vec3 center;    // m, middle of the face
  Vec3 normal;    // unit, outward
  Vec3 slope;     // unit, down the slope
  double length;  // m, along `slope`
  double width;   // m, along y (unused in 2D)
  double board;   // m, thickness of the board below the face, at least three cells

  /// Middle of the lower edge, where the snow leaves the panel.
  Vec3 lower_edge() const { return center + 0.5 * length * slope; }
  /// Middle of the upper edge.
  Vec3 upper_edge() const { return center - 0.5 * length * slope; }
};

/// Throws InputError if the scene has no panel.
PanelFrame panel_frame(const Scene& scene);

/// Vertical distance of a point above the ground (above z = 0 if the scene has no ground).
double height_above_ground(const Scene& scene, const Vec3& point);

/// The obstacles "ground" and "panel", then the scene's own, without the domain's sides.
std::vector<ObstacleSpec> assemble_obstacles(const Scene& scene);

/// Whether a layer or body is laid at the start of `event` (1 is the first).
template <class Part>
bool is_added_in(const Part& part, int event) {
  return part.event == 0 || part.event == event;
}

/// The slab laid at the start of `event`, from the panel upwards, a body for each of its layers.
/// Its underside is `lift` metres (>= 0) above the panel, measured along the normal: later slabs
/// lie on the snow that remained there.
std::vector<BodySpec> assemble_slab(const Scene& scene, int event, double lift = 0.0);

/// The thickness of the slab laid at the start of `event`, m.
double slab_thickness(const Slab& slab, int event);

/// The bodies that appear at the start of `event`: the slab, then the scene's bodies of that event.
std::vector<BodySpec> assemble_bodies(const Scene& scene, int event, double lift = 0.0);

/// The different snows of the slab and the bodies, in order of their first appearance.
std::vector<Snow> assemble_snows(const Scene& scene);

/// The snow of a body or layer.
template <class Part>
const Snow& snow_of(const Scene& scene, const Part& part) {
  return part.snow ? *part.snow : scene.snow;
}

/// Index of a snow in `snows`, which must contain it.
int material_id_of(const Snow& snow, const std::vector<Snow>& snows);

}  // namespace snowshed
