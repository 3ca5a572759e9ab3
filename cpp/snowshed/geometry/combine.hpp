// Solids made from other solids. The normal is that of the operand with the nearest surface.
#pragma once

#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// Returns the union of the shapes, of which there must be at least one. Outside, the distance is
/// exact; inside, it is a lower bound of the depth. The inradius is that of the largest operand,
/// a lower bound.
Shape unite(std::vector<Shape> shapes);

/// Returns `first` without `others`. The magnitude of the distance is a lower bound; the inradius
/// is that of `first`, an upper bound.
Shape subtract(Shape first, std::vector<Shape> others);

/// Returns the points rotation * x + translation for x in `shape`.
Shape transform(Shape shape, const Mat3& rotation, const Vec3& translation);

/// Returns all points within `offset` >= 0 metres of `shape`.
Shape dilate(Shape shape, double offset);

}  // namespace snowshed::geometry
