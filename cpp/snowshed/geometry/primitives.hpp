// Solids with closed-form signed distances. Lengths are in metres.
//
// These functions do not check their arguments; build_shape checks those of a scene.
#pragma once

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// Returns the half-space below the plane through `point` with outward normal `normal`.
Shape make_plane(const Vec3& point, const Vec3& normal);

/// Returns the axis-aligned box with edge lengths `size`. An infinite size along y makes the
/// rectangle of a two-dimensional scene.
Shape make_box(const Vec3& center, const Vec3& size);

/// Returns a box in any orientation; its axes must be a rotation.
Shape make_box(const OrientedBox& box);

/// Returns the ball of the given radius.
Shape make_sphere(const Vec3& center, double radius);

/// Returns the cylinder with flat caps at `from` and `to`, which must differ.
Shape make_cylinder(const Vec3& from, const Vec3& to, double radius);

/// Returns all points within `radius` of the segment from `from` to `to`.
Shape make_capsule(const Vec3& from, const Vec3& to, double radius);

/// Returns a panel: a box below the rectangle centred on `center` with outward normal `normal`. The
/// rectangle has the `length` along the slope and the `width` across it (infinite in 2D); the box
/// reaches `thickness` below it. The slope direction is t = y x n, so n = (sin, 0, cos) gives
/// t = (cos, 0, -sin).
///
/// Inside the panel the normal is +n or -n, that of the nearer face, and never that of an edge.
/// Snow that sinks a little into the panel near its edge is thus pushed back onto the face, not
/// sideways over the edge.
Shape make_plate(const Vec3& center, const Vec3& normal, double length, double width,
                 double thickness);

}  // namespace snowshed::geometry
