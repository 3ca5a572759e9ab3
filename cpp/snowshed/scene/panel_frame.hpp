// The position of the panel's face in space.
//
// x points down the slide direction, y across, z up. The origin of x is the panel's centre.
// The ground passes through the origin with normal (sin psi, 0, cos psi); the panel's face has
// normal (sin phi, 0, cos phi), and its lower edge stands `height` vertically above the ground.
// Figure 3.1.1 of the thesis shows both.
#pragma once

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// The panel's sliding face.
struct PanelFrame {
  Vec3 center;             // m, middle of the face
  Vec3 normal;             // unit, outward
  Vec3 slope;              // unit, down the slope
  double length;           // m, along `slope`
  double width;            // m, along y (unused in 2D)
  double board_thickness;  // m, of the board below the face, at least three cells

  /// Middle of the lower edge, where the snow leaves the panel.
  Vec3 lower_edge() const { return center + 0.5 * length * slope; }
  /// Middle of the upper edge.
  Vec3 upper_edge() const { return center - 0.5 * length * slope; }
};

/// Throws InputError if the scene has no panel.
PanelFrame panel_frame(const Scene& scene);

/// Vertical distance of a point above the ground (above z = 0 if the scene has no ground).
double height_above_ground(const Scene& scene, const Vec3& point);

/// Outward normal of a plane that falls in the slide direction at an angle in degrees.
Vec3 tilted_normal(double tilt);

}  // namespace snowshed::scene
