// Exact orientation of three points in a plane.
#pragma once

#include <array>
#include <cmath>

#include "snowshed/geometry/point2.hpp"

namespace snowshed::geometry {

/// Returns a number whose sign is the sense in which a, b, c turn: positive counter-clockwise,
/// negative clockwise, 0 where they lie on one line. The sign is exact; the magnitude is about
/// twice the area of the triangle. A rounded determinant decides where its error bound allows; else
/// the six products are summed without rounding (Shewchuk 1997, doi:10.1007/PL00009321).
inline double orientation(const Point2& a, const Point2& b, const Point2& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  constexpr double relative_error = 3.3306690738754716e-16;  // (3 + 16 u) u, u = 2^-53
  if (std::abs(left - right) > relative_error * (std::abs(left) + std::abs(right)))
    return left - right;

  // Shewchuk's expansion: the components do not overlap and grow in magnitude, so the last nonzero
  // one has the sign of the sum.
  std::array<double, 12> parts{};
  int count = 0;
  const auto add = [&](double value) {
    for (int i = 0; i < count; ++i) {
      const double sum = value + parts[i], shared = sum - value;
      parts[i] = (value - (sum - shared)) + (parts[i] - shared);
      value = sum;
    }
    parts[count++] = value;
  };
  const auto add_product = [&](double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  };
  add_product(a[0], b[1]);
  add_product(-a[0], c[1]);
  add_product(-c[0], b[1]);
  add_product(-a[1], b[0]);
  add_product(a[1], c[0]);
  add_product(c[1], b[0]);
  for (int i = count - 1; i >= 0; --i)
    if (parts[i] != 0) return parts[i];
  return 0;
}

}  // namespace snowshed::geometry
