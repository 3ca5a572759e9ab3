// Solids with closed-form signed distances. Lengths in metres.
//
// Arguments are trusted here; build_shape checks those that come from a scene.
#pragma once

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// The half-space below the plane through `point` with outward normal `normal`.
Shape make_plane(const Vec3& point, const Vec3& normal);

/// Axis-aligned box with edge lengths `size`. An infinite size along y makes the
/// rectangle of a two-dimensional scene.
Shape make_box(const Vec3& center, const Vec3& size);

/// A box in any orientation; its axes must be a rotation.
Shape make_box(const OrientedBox& box);

Shape make_sphere(const Vec3& center, double radius);

/// Cylinder with flat caps at `from` and `to`, which must differ.
Shape make_cylinder(const Vec3& from, const Vec3& to, double radius);

/// All points within `radius` of the segment.
Shape make_capsule(const Vec3& from, const Vec3& to, double radius);

/// A panel: a box below the rectangle centred on `center` with outward normal `normal`,
/// `length` along the slope, `width` across (infinite in 2D), `thickness` below the face.
/// The slope direction is t = y x n, so n = (sin, 0, cos) gives t = (cos, 0, -sin).
///
/// Inside it the normal is +n or -n, whichever face is nearer, and never that of an edge:
/// snow that sinks a little into the panel near its edge is pushed back onto the face,
/// not sideways over the edge.
Shape make_plate(const Vec3& center, const Vec3& normal, double length, double width,
                 double thickness);

}  // namespace snowshed
