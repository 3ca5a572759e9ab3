// Steps in elevations that no ground has, for example because a raster has 0 for missing values.
#pragma once

#include <string>

#include "snowshed/geometry/height_field.hpp"
#include "snowshed/geometry/polygon.hpp"

namespace snowshed::methods::slide {

/// Describes the first step between neighbouring nodes that is impossible on ground: more than 100
/// m at more than 80 degrees and `max_slope`, or more than 10 m from exactly 0 m at more than
/// `max_slope` degrees. Returns an empty text if there is none.
std::string impossible_cliff(const geometry::HeightField& field, double max_slope);

/// Describes the first step higher than 10 m and steeper than `max_slope` degrees between
/// neighbouring nodes in or beside an area. Returns an empty text if there is none. Coordinates of
/// the area begin at the south-west node.
std::string cliff_under(const geometry::Polygon& area, const geometry::HeightField& field,
                        double max_slope);

}  // namespace snowshed::methods::slide
