// Polygons on the map.
#pragma once

#include <vector>

#include "snowshed/geometry/point2.hpp"

namespace snowshed::geometry {

using Ring = std::vector<Point2>;  // without a repeated last point

/// An area within an outline and outside of its holes.
struct Polygon {
  Ring outline;
  std::vector<Ring> holes;
};

/// The smallest rectangle around a ring, parallel to the axes.
struct RingBounds {
  Point2 low, high;

  /// Whether a point lies in it, the edges included.
  bool contain(const Point2& p) const {
    return p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1];
  }
};
RingBounds bounds_of(const Ring& ring);

/// Whether a point lies within a ring (even-odd rule).
bool contains(const Ring& ring, const Point2& point);

/// Whether a point lies within the outline and in none of the holes.
bool contains(const Polygon& polygon, const Point2& point);

/// Twice the area that a ring encloses, positive where it runs counterclockwise, m2.
double twice_signed_area(const Ring& ring);

/// The area of a ring within a rectangle, m2 (clipped edge by edge: Sutherland and Hodgman 1974).
double area_within(const Ring& ring, const Point2& low, const Point2& high);

/// The same for a polygon, without its holes.
double area_within(const Polygon& polygon, const Point2& low, const Point2& high);

/// The ring with every edge moved outward by a distance (> 0, m) and the corners mitred; where a
/// mitre would reach farther than four distances it is cut off.
Ring widened(const Ring& ring, double distance);

/// The same, with the edges moved to the right of the ring's direction, or left if `distance` < 0.
Ring offset_ring(const Ring& ring, double distance);

/// Whether two edges of a ring cross or touch anywhere except at a corner that they share.
bool crosses_itself(const Ring& ring);

}  // namespace snowshed::geometry
