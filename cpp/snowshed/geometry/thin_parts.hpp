// The parts of a solid that are thinner than a grid can resolve.
#pragma once

#include <optional>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

/// A piece of the middle of a thin part: a rectangle between both of its faces. Its edges lie half
/// the thickness inside the edges of the part. The rectangle of a thin rod is a line, and that of a
/// small ball is a point, both up to rounding.
struct ThinPart {
  Vec3 middle;      // m
  Vec3 normal;      // across the part, unit
  double half;      // m, half of the thickness
  Vec3 corners[4];  // corners of the rectangle, m
};

/// Returns pieces of all parts of a solid that are thinner than `2 half`. They are so near to each
/// other that balls of the radius `half` around them leave no gap. In 2D they lie in the plane
/// y = 0.
///
/// The surface is found cell by cell, each as large as `half`. The thickness at a point of the
/// surface is the length of the chord along its normal. It counts if the faces at both ends are
/// parallel within 40 degrees, so that corners of thick parts are not thin. If the faces are not
/// parallel, as in a triangular bar, the greatest depth within reach decides. Only the signs of
/// distances are used, because depths of combined solids are lower bounds.
///
/// A solid whose surface fills more than 400000 cells is searched in larger cells; parts that are
/// smaller than the cells may be missed.
std::vector<ThinPart> find_thin_parts(const LevelSet& shape, double half, int dimension);

/// Returns a thin part of a solid that only planes bound, if two of them are nearer than `2 half`.
std::optional<ThinPart> find_thin_plate(const LevelSet& shape, double half, int dimension);

}  // namespace snowshed::geometry
