#include "snowshed/methods/range.hpp"

#include <cmath>

#include "snowshed/core/message_format.hpp"

namespace snowshed::methods {

bool Range::is_usual(double value) const {
  const double magnitude = std::abs(value);
  return magnitude == 0.0 || (usual_min <= magnitude && magnitude <= usual_max);
}

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (open_min ? value > min : value >= min) && (open_max ? value < max : value <= max);
}

std::string Range::text(const std::string& unit) const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  if (!has_min && !has_max) return "any finite number";
  std::string text = "value";
  if (has_min) text = show(min) + (open_min ? " < " : " <= ") + text;
  if (has_max) text += (open_max ? " < " : " <= ") + show(max);
  return unit.empty() ? text : text + " " + unit;
}

}  // namespace snowshed::methods
