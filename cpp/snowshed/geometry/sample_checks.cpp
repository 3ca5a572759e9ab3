#include "snowshed/geometry/sample_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/rebuild_distance.hpp"

namespace snowshed::geometry {
namespace {

/// Neighbouring samples of an exact distance differ by at most the spacing; those of approximate
/// distances may differ by the spacing times this factor.
constexpr double slope_tolerance = 1.25;
/// The mean slope of a distance over the whole surface is 1; values below this are no distances.
constexpr double min_slope = 0.6;

using Sample = std::array<std::size_t, 3>;

std::string sample_name(const Sample& at) {
  std::ostringstream text;
  text << "sample [" << at[0] << "][" << at[1] << "][" << at[2] << "]";
  return text.str();
}

float value_at(const GridSamples& s, const Sample& at) {
  return s.values[s.index(at[0], at[1], at[2])];
}

/// Calls visit(axis, neighbour) for the neighbours of a sample along the axes.
template <class Visit>
void for_neighbours(const GridSamples& s, const Sample& at, Visit visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {false, true}) {
      if (up ? at[axis] + 1 == s.counts[axis] : at[axis] == 0) continue;
      Sample neighbour = at;
      neighbour[axis] += up ? 1 : std::size_t(-1);
      visit(axis, neighbour);
    }
}

void check_slopes(const GridSamples& s, const std::string& where) {
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    const Sample at{i, j, k};
    for_neighbours(s, at, [&](int, const Sample& next) {
      const double step = std::abs(double(value_at(s, at)) - value_at(s, next));
      if (step <= slope_tolerance * s.spacing) return;
      std::ostringstream what;
      what << sample_name(std::max(at, next)) << " differs from its neighbour by " << step
           << " m over " << s.spacing << " m: not a signed distance in metres";
      throw InputError(where, what.str());
    });
  });
}

/// Signs at the border of a grid.
struct Border {
  std::size_t samples = 0, inside = 0, top = 0, top_inside = 0, bottom_inside = 0;
  double highest_at_sides = -infinity;  // value, m; the bottom does not count
};

Border border_of(const GridSamples& s) {
  Border border;
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    const bool top = k + 1 == s.counts[2];
    const bool side =
        i == 0 || i + 1 == s.counts[0] || (!s.is_flat() && (j == 0 || j + 1 == s.counts[1]));
    if (!top && !side && k != 0) return;
    const double value = s.values[s.index(i, j, k)];
    ++border.samples;
    border.inside += value < 0;
    border.top += top;
    border.bottom_inside += k == 0 && value < 0;
    border.top_inside += top && value < 0;
    if (top || side) border.highest_at_sides = std::max(border.highest_at_sides, value);
  });
  return border;
}

void check_sign(const GridSamples& s, double highest, const std::string& where) {
  const Border border = border_of(s);
  if (!(highest > 0) || 2 * border.inside <= border.samples ||
      2 * border.top_inside <= border.top ||
      (border.highest_at_sides >= highest && border.bottom_inside > 0))
    return;
  throw InputError(
      where,
      "the values are negative at " +
          std::to_string(int(std::lround(100.0 * double(border.inside) / double(border.samples)))) +
          " % of the border and at the top of the grid, and positive within: the sign is the other "
          "way round. Distances are negative inside the solid and positive outside; multiply them "
          "by -1. (For a solid around a cavity, subtract the cavity from a box.)");
}

/// The mean slope of the values where they change sign. Along each axis the larger difference to
/// the two neighbours counts, because thin walls have kinks.
double mean_slope_at_surface(const GridSamples& s) {
  double sum = 0;
  std::size_t count = 0;
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    const Sample at{i, j, k};
    const double value = value_at(s, at);
    Vec3 steps = Vec3::Zero();
    bool crossed = false;
    for_neighbours(s, at, [&](int axis, const Sample& next) {
      const double other = value_at(s, next);
      steps[axis] = std::max(steps[axis], std::abs(other - value));
      crossed = crossed || (other < 0) != (value < 0);
    });
    if (!crossed) return;
    sum += steps.norm() / s.spacing;
    ++count;
  });
  return count > 0 ? sum / double(count) : 1.0;
}

/// The distances outside and inside at which the samples were clipped; infinity if they were not.
Band clipping_band(const GridSamples& s) {
  // Distances in other norms have some samples in corners that equal all their neighbours.
  constexpr std::size_t min_level_samples = 4;
  const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end());
  if (!(*low < 0) || !(*high > 0)) return {infinity, infinity};
  std::size_t level_inside = 0, level_outside = 0;
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    const Sample at{i, j, k};
    const float value = value_at(s, at);
    if (value != *low && value != *high) return;
    bool level = true;
    for_neighbours(s, at, [&](int, const Sample& next) { level &= value_at(s, next) == value; });
    if (level) ++(value < 0 ? level_inside : level_outside);
  });
  return {level_outside < min_level_samples ? infinity : *high,
          level_inside < min_level_samples ? infinity : -*low};
}

std::string note_on(const Band& band) {
  std::string text = "the distances were clipped at ";
  if (std::isfinite(band.outside)) text += show_rounded(band.outside) + " m outside";
  if (std::isfinite(band.outside) && std::isfinite(band.inside)) text += " and ";
  if (std::isfinite(band.inside)) text += show_rounded(band.inside) + " m inside";
  return text + " the solid; beyond that they were rebuilt from its surface";
}

}  // namespace

void require_counts(const GridSamples& s, const std::string& where) {
  std::size_t total = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t n = s.counts[axis], least = axis == 1 ? 1 : 2;
    if (n < least || n > s.values.size())
      throw InputError(where, std::to_string(n) + " samples along axis " + std::to_string(axis) +
                                  "; at least 2 are needed");
    total *= n;
    if (total > s.values.size()) break;  // before it overflows
  }
  if (total != s.values.size()) throw InputError(where, "the counts do not fit the values");
  s.for_each([&](std::size_t i, std::size_t j, std::size_t k) {
    if (!std::isfinite(s.values[s.index(i, j, k)]))
      throw InputError(where, sample_name({i, j, k}) + " is not finite");
  });
}

void require_distances(const GridSamples& samples, const std::string& where) {
  check_slopes(samples, where);
  const auto [low, high] = std::minmax_element(samples.values.begin(), samples.values.end());
  if (!(*low < 0)) throw InputError(where, "no sample is negative: the solid is empty");
  check_sign(samples, *high, where);
}

void repair_distances(GridSamples& samples, const std::string& where,
                      std::vector<std::string>* notes) {
  const auto tell = [&](const std::string& note) {
    if (notes) notes->push_back(where + ": " + note);
  };
  const double slope = mean_slope_at_surface(samples);
  if (slope < min_slope) {
    rebuild_distance(samples, Band{0, 0}, where);
    std::ostringstream text;
    text << "the gradient at the surface is " << slope
         << " instead of 1 (is the unit wrong?); the distances were rebuilt from the surface";
    return tell(text.str());
  }
  const Band band = clipping_band(samples);
  if (!std::isfinite(band.outside) && !std::isfinite(band.inside)) return;
  rebuild_distance(samples, band, where);
  tell(note_on(band));
}

GridSamples samples_at_y0(const GridSamples& s, const std::string& where) {
  if (s.is_flat()) return s;
  const double plane = -s.origin.y() / s.spacing, last = double(s.counts[1] - 1);
  constexpr double rounding = 1e-6;
  if (!(plane >= -rounding && plane <= last + rounding)) {
    std::ostringstream text;
    text << "the grid lies between y = " << s.origin.y() << " and "
         << s.origin.y() + s.spacing * last
         << " m and does not reach the plane y = 0 of a two-dimensional scene";
    throw InputError(where, text.str());
  }
  const double inside = std::clamp(plane, 0.0, last);
  const std::size_t low = std::min(std::size_t(inside), s.counts[1] - 2);
  const double part = inside - double(low);
  GridSamples section{s.origin, s.spacing, {s.counts[0], 1, s.counts[2]}, {}};
  section.origin.y() = 0;
  section.values.reserve(s.counts[0] * s.counts[2]);
  bool any = false;
  section.for_each([&](std::size_t i, std::size_t, std::size_t k) {
    const double a = s.values[s.index(i, low, k)], b = s.values[s.index(i, low + 1, k)];
    section.values.push_back(float(a + part * (b - a)));
    any = any || section.values.back() < 0;
  });
  if (!any)
    throw InputError(where, "the solid does not meet the plane y = 0 of a two-dimensional scene");
  return section;
}

}  // namespace snowshed::geometry
