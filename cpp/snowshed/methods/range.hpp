// Values that a field may take.
#pragma once

#include <limits>
#include <string>

namespace snowshed::methods {

/// Whether a field must be given.
enum class Need { optional, required, required_in_3d };

inline bool is_required(Need need, int dimension) {
  return need == Need::required || (need == Need::required_in_3d && dimension == 3);
}

/// An interval of numbers; NaN and infinity are never in it.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  // min itself is excluded
  bool open_max = false;
  Need need = Need::optional;

  constexpr Range up_to(double limit) const { return {min, limit, open_min, false, need}; }
  constexpr Range below(double limit) const { return {min, limit, open_min, true, need}; }
  constexpr Range required() const { return {min, max, open_min, open_max, Need::required}; }
  constexpr Range required_in_3d() const {
    return {min, max, open_min, open_max, Need::required_in_3d};
  }

  /// The range in a scene of that dimension: a field that only 3D needs may stay zero in 2D.
  constexpr Range in(int dimension) const {
    const bool unused = need == Need::required_in_3d && dimension == 2;
    return {min, max, open_min && !unused, open_max, need};
  }

  bool contains(double value) const;

  /// "0 <= value < 0.5 m"; "any finite number" without limits.
  std::string text(const std::string& unit = "") const;
};

inline constexpr Range anything{};
inline constexpr Range positive{0.0, anything.max, true, false, Need::optional};
inline constexpr Range non_negative{0.0, anything.max, false, false, Need::optional};
inline constexpr Range fraction = non_negative.up_to(1.0);
constexpr Range between(double min, double max) { return {min, max, false, false, Need::optional}; }
constexpr Range exactly(double value) { return between(value, value); }

}  // namespace snowshed::methods
