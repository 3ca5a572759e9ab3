#include "snowshed/methods/slide/cliffs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "snowshed/core/angles.hpp"

namespace snowshed::methods::slide {
namespace {

constexpr double min_cliff = 10;       // m; lower ones are rocks and walls in fine rasters
constexpr double max_cliff = 100;      // m
constexpr double max_rock_slope = 80;  // degrees, of faces higher than `max_cliff`

/// Two neighbouring nodes, the second one in the east or in the north of the first.
struct HeightStep {
  int column, row, east, north;
};

double rise(const geometry::HeightField& f, double slope) {
  return slope < 90 ? std::tan(radians(slope)) * f.cell : std::numeric_limits<double>::infinity();
}

std::string describe_step(const geometry::HeightField& f, const HeightStep& s) {
  const double from = f.height(s.column, s.row), to = f.height(s.column + s.east, s.row + s.north);
  char text[300];
  std::snprintf(text, sizeof text,
                "%.6g m beside %.6g m within %.6g m, at (%.10g, %.10g) and (%.10g, %.10g)", from,
                to, f.cell, f.west + s.column * f.cell, f.south + s.row * f.cell,
                f.west + (s.column + s.east) * f.cell, f.south + (s.row + s.north) * f.cell);
  return text;
}

/// Describes the first step between nodes of a rectangle for which a test holds.
template <class Test>
std::string first_step(const geometry::HeightField& f, const int (&low)[2], const int (&high)[2],
                       Test test) {
  for (int row = low[1]; row <= high[1]; ++row)
    for (int column = low[0]; column <= high[0]; ++column)
      for (const int east : {1, 0}) {
        const HeightStep step{column, row, east, 1 - east};
        if (column + step.east >= f.columns || row + step.north >= f.rows) continue;
        const double from = f.height(column, row),
                     to = f.height(column + step.east, row + step.north);
        if (std::abs(to - from) > min_cliff && test(step, from, to)) return describe_step(f, step);
      }
  return "";
}

}  // namespace

std::string impossible_cliff(const geometry::HeightField& f, double max_slope) {
  const double highest = std::max(max_cliff, rise(f, std::max(max_rock_slope, max_slope)));
  const double beside_zero = rise(f, max_slope);
  return first_step(f, {0, 0}, {f.columns - 1, f.rows - 1},
                    [&](const HeightStep&, double from, double to) {
                      const double step = std::abs(to - from);
                      return step > highest || ((from == 0 || to == 0) && step > beside_zero);
                    });
}

std::string cliff_under(const geometry::Polygon& area, const geometry::HeightField& f,
                        double max_slope) {
  int low[2], high[2];
  for (const int axis : {0, 1}) {
    const auto less = [&](const geometry::Point2& a, const geometry::Point2& b) {
      return a[axis] < b[axis];
    };
    const auto [first, last] = std::minmax_element(area.outline.begin(), area.outline.end(), less);
    const double last_index = (axis == 0 ? f.columns : f.rows) - 1;
    low[axis] = int(std::clamp((*first)[axis] / f.cell - 1, 0.0, last_index));
    high[axis] = int(std::clamp((*last)[axis] / f.cell + 1, 0.0, last_index));
  }
  const double steepest = rise(f, max_slope);
  return first_step(f, low, high, [&](const HeightStep& s, double from, double to) {
    const geometry::Point2 south_west = {(s.column - 1) * f.cell, (s.row - 1) * f.cell},
                           north_east = {(s.column + s.east + 1) * f.cell,
                                         (s.row + s.north + 1) * f.cell};
    return std::abs(to - from) > steepest &&
           geometry::area_within(area, south_west, north_east) > 0;
  });
}

}  // namespace snowshed::methods::slide
