#include "snowshed/io/film_frame.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed::io {

std::int32_t FilmQuantity::code(double value) const {
  const double scale = linear_steps * step;
  const double code = linear_steps * std::asinh(value / scale);
  return std::isfinite(code) ? std::int32_t(std::lround(code)) : 0;  // asinh never exceeds 711
}

double FilmQuantity::value(std::int32_t code) const {
  return linear_steps * step * std::sinh(double(code) / linear_steps);
}

}  // namespace snowshed::io
