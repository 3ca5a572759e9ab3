// Angles: users write all of them in degrees.
#pragma once

namespace snowshed {

inline constexpr double pi = 3.14159265358979323846;

inline constexpr double radians(double degrees) { return degrees * (pi / 180.0); }

}  // namespace snowshed
