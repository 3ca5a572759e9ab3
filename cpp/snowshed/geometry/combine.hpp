// Solids made from other solids. The normal is that of the operand whose surface is nearest.
#pragma once

#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// Everything in any of the shapes (at least one). The distance is exact outside and a lower
/// bound of the depth inside; the inradius is the largest operand's, a lower bound.
Shape unite(std::vector<Shape> shapes);

/// `first` without `others`. The distance is a lower bound of its magnitude;
/// the inradius is that of `first`, an upper bound.
Shape subtract(Shape first, std::vector<Shape> others);

/// The points rotation * x + translation for x in `shape`.
Shape transform(Shape shape, const Mat3& rotation, const Vec3& translation);

/// Every point within `offset` >= 0 metres of `shape`.
Shape dilate(Shape shape, double offset);

/// `shape` as a two-dimensional scene sees it: the same distances, normals turned into the
/// plane y = 0. The distance to a solid that is not constant in y is a lower bound of that
/// to its section.
Shape cross_section(Shape shape);

}  // namespace snowshed
