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
  // Magnitudes that snow, structures and experiments have. Others are allowed, but noted: they are
  // probably in another unit.
  double usual_min = 0.0;
  double usual_max = std::numeric_limits<double>::infinity();

  constexpr Range up_to(double limit) const { return with_max(limit, false); }
  constexpr Range below(double limit) const { return with_max(limit, true); }
  constexpr Range required() const { return with_need(Need::required); }
  constexpr Range required_in_3d() const { return with_need(Need::required_in_3d); }
  constexpr Range usual(double from, double to) const {
    Range range = *this;
    range.usual_min = from;
    range.usual_max = to;
    return range;
  }

  /// The range in a scene of that dimension: a field that only 3D needs may stay zero in 2D.
  constexpr Range in(int dimension) const {
    Range range = *this;
    if (need == Need::required_in_3d && dimension == 2) range.open_min = false;
    return range;
  }

  bool contains(double value) const;

  /// Whether a value has a usual magnitude. Zero always has: it stands for "none".
  bool is_usual(double value) const;

  /// "0 <= value < 0.5 m"; "any finite number" without limits.
  std::string text(const std::string& unit = "") const;

 private:
  constexpr Range with_max(double limit, bool open) const {
    Range range = *this;
    range.max = limit;
    range.open_max = open;
    return range;
  }
  constexpr Range with_need(Need other) const {
    Range range = *this;
    range.need = other;
    return range;
  }
};

inline constexpr Range anything{};
inline constexpr Range positive{0.0, anything.max, true, false, Need::optional};
inline constexpr Range non_negative{0.0, anything.max, false, false, Need::optional};
inline constexpr Range fraction = non_negative.up_to(1.0);
constexpr Range between(double min, double max) { return {min, max, false, false, Need::optional}; }
constexpr Range exactly(double value) { return between(value, value); }

}  // namespace snowshed::methods
