// Solids whose thin parts are made thicker, so that snow on a grid cannot pass them.
#pragma once

#include <optional>
#include <vector>

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/thin_parts.hpp"

namespace snowshed::geometry {

/// Parts that were made thicker.
struct Thickening {
  Vec3 thinnest;     // where the solid is thinnest, m; without meaning if `is_dilated`
  double thickness;  // m, there
  double outward;    // m, by which the surface moves out there, on each side
  bool is_dilated;   // the solid is dilated as a whole
};

/// A solid and its changes.
struct ThickSolid {
  Shape shape;
  std::optional<Thickening> thickening;  // none if the solid was not changed
};

/// Returns a solid that is nowhere thinner than `2 half` metres, and equals the given one where
/// that is thicker. Convex solids are dilated until they are thick enough. In other solids only
/// the thin parts (find_thin_parts) grow: all points within `half` of their middle are added. (A
/// plate is dilated by this, too.) Solids that are thick enough are returned unchanged, so a second
/// call changes nothing.
ThickSolid thickened(Shape shape, double half, int dimension);

}  // namespace snowshed::geometry
