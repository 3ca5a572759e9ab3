// Stands in for <cmath> on a graphics card, where the compiler brings no standard library but knows
// these functions without a header.
#pragma once

namespace std {
using ::abs;
using ::asinh;
using ::cos;
using ::exp;
using ::expm1;
using ::floor;
using ::log;
using ::log1p;
using ::pow;
using ::sin;
using ::sqrt;
}  // namespace std
