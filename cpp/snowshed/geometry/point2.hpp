// A point in a plane.
#pragma once

#include <array>

namespace snowshed::geometry {

using Point2 = std::array<double, 2>;  // on the map: m, east and north

}  // namespace snowshed::geometry
