// Steps in elevations that no ground has: missing values that a raster holds as 0, for example.
#pragma once

#include <string>

#include "snowshed/geometry/height_field.hpp"
#include "snowshed/geometry/polygon.hpp"

namespace snowshed {

/// Tells of neighbouring nodes that differ in height as no ground does; empty where there are none:
/// by more than 100 m at more than 80 degrees and `max_slope`, or from exactly 0 m by more than
/// 10 m at more than `max_slope` degrees.
std::string impossible_cliff(const HeightField& field, double max_slope);

/// Tells of neighbouring nodes in or beside an area that differ in height by more than 10 m at more
/// than `max_slope` degrees; empty where there are none. The area is given from the south-west
/// node.
std::string cliff_under(const Polygon& area, const HeightField& field, double max_slope);

}  // namespace snowshed
