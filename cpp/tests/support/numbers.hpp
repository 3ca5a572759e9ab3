// Numbers that tests of any kind need.
#pragma once

#include <limits>

namespace snowshed {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double inf = std::numeric_limits<double>::infinity();

}  // namespace snowshed
