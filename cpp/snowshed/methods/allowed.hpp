// The ranges that many fields of a scene share.
#pragma once

#include "snowshed/methods/range.hpp"

namespace snowshed::methods {

// Limits far beyond any structure or snow; they keep arithmetic on untrusted input finite.
namespace allowed {
inline constexpr Range coordinate = between(-1e6, 1e6);         // m
inline constexpr Range map_coordinate = between(-1e8, 1e8);     // m
inline constexpr Range size = positive.up_to(1e6);              // m
inline constexpr Range size_or_zero = non_negative.up_to(1e6);  // m
inline constexpr Range pressure = positive.up_to(1e12);         // Pa
inline constexpr Range speed = between(-1e4, 1e4);              // m/s, rad/s
inline constexpr Range time = non_negative.up_to(1e9);          // s
inline constexpr Range duration = positive.up_to(1e9);          // s
inline constexpr Range coefficient = non_negative.up_to(100.0);
}  // namespace allowed

}  // namespace snowshed::methods
