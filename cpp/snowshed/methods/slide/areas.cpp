#include "snowshed/methods/slide/areas.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"

namespace snowshed::methods::slide {
namespace {

/// Whether the direction from the first corner to the others turns mostly counterclockwise.
bool mostly_counterclockwise(const geometry::Ring& ring) {
  std::vector<double> angles;
  for (std::size_t i = 1; i < ring.size(); ++i)
    angles.push_back(std::atan2(ring[i][1] - ring[0][1], ring[i][0] - ring[0][0]));
  std::size_t growing = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) growing += angles[i] >= angles[i - 1];
  return 2 * growing >= angles.size() - 1;
}

double radius_of(Reach reach) { return reach == Reach::edge ? 1e-3 : std::sqrt(2.0); }  // cells

/// The range of nodes along one axis that a ring can contain.
struct NodeRange {
  int begin, end;
};
NodeRange nodes_within(const geometry::Ring& ring, int axis, int nodes) {
  double low = ring[0][axis], high = low;
  for (const geometry::Point2& p : ring) {
    low = std::min(low, p[axis]);
    high = std::max(high, p[axis]);
  }
  const double last = nodes;
  return {int(std::clamp(std::floor(low), 0.0, last)),
          int(std::clamp(std::ceil(high) + 1, 0.0, last))};
}

/// Returns a ring in units of cells.
geometry::Ring scaled(const geometry::Ring& ring, double cell) {
  geometry::Ring result;
  for (const geometry::Point2& p : ring) result.push_back({p[0] / cell, p[1] / cell});
  return result;
}

/// The node of a terrain at the south-west node of a raster. Throws InputError if the nodes differ.
struct FirstNode {
  int column, row;
};
FirstNode first_node_of(const geometry::HeightField& map, const Terrain& terrain) {
  constexpr double rounding = 1e-6;  // cells
  const double east = map.west / terrain.cell(), north = map.south / terrain.cell();
  const double longest = std::max({map.columns, map.rows, 1});
  const auto is_whole = [](double x) { return std::abs(x - std::round(x)) <= rounding; };
  if (std::abs(map.cell / terrain.cell() - 1) * longest > rounding || !is_whole(east) ||
      !is_whole(north))
    throw InputError("/terrain/thickness_file",
                     "has cells of " + show_rounded(map.cell) + " m from (" +
                         show_rounded(terrain.west() + map.west) + ", " +
                         show_rounded(terrain.south() + map.south) +
                         "); the mode \"compatible\" needs those of the terrain, " +
                         show_rounded(terrain.cell()) + " m from (" + show_rounded(terrain.west()) +
                         ", " + show_rounded(terrain.south()) + ")");
  return {int(std::lround(east)), int(std::lround(north))};
}

/// Calls visit(column, row) for the nodes within an area.
template <class Visit>
void for_nodes_within(const Area& area, const Terrain& terrain, Reach reach, Visit visit) {
  const geometry::Ring ring =
      widened_as_avaframe(scaled(area.polygon.outline, terrain.cell()), radius_of(reach));
  std::vector<geometry::Ring> holes;
  for (const geometry::Ring& hole : area.polygon.holes)
    holes.push_back(scaled(hole, terrain.cell()));
  const geometry::Polygon polygon{ring, std::move(holes)};
  const NodeRange columns = nodes_within(ring, 0, terrain.columns());
  const NodeRange rows = nodes_within(ring, 1, terrain.rows());
  for (int row = rows.begin; row < rows.end; ++row)
    for (int column = columns.begin; column < columns.end; ++column)
      if (geometry::contains(polygon, {double(column), double(row)})) visit(column, row);
}

/// Thickness at the nodes within areas that share a raster.
std::vector<double> thickness_of_raster(const std::vector<Area>& areas, const Terrain& terrain) {
  const FirstNode first = first_node_of(*areas.front().map, terrain);
  std::vector<double> values(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for (std::size_t i = 0; i < areas.size(); ++i)
    for_nodes_within(areas[i], terrain, Reach::edge, [&](int column, int row) {
      values[terrain.index(column, row)] =
          thickness_in_cell(areas[i], terrain, column - first.column, row - first.row,
                            "/terrain/release/" + std::to_string(i));
    });
  return values;
}

}  // namespace

double thickness_in_cell(const Area& area, const Terrain& terrain, int column, int row,
                         const std::string& path) {
  const geometry::HeightField& m = *area.map;
  const std::string name = area.name.empty() ? "" : "\"" + area.name + "\" ";
  if (column < 0 || row < 0 || column >= m.columns || row >= m.rows)
    throw InputError(path, name + "reaches beyond the thickness raster");
  const double h = m.height(column, row);
  if (h > 0 && h <= area.max_thickness) return h;
  throw InputError(path, name + "the thickness raster has " +
                             (std::isnan(h) ? "no value" : std::to_string(h) + " m") + " at (" +
                             std::to_string(terrain.west() + m.west + column * m.cell) + ", " +
                             std::to_string(terrain.south() + m.south + row * m.cell) +
                             "); allowed: above 0 and at most " +
                             std::to_string(area.max_thickness) + " m");
}

std::vector<double> released_at_nodes(const std::vector<Area>& release, const Terrain& terrain,
                                      Mode mode) {
  if (mode == Mode::improved) return thickness_at_nodes(release, terrain, Reach::edge);
  if (release.empty() || !release.front().map)
    return thickness_at_nodes(release, terrain, Reach::one_cell);
  return thickness_of_raster(release, terrain);
}

geometry::Ring widened_as_avaframe(const geometry::Ring& outline, double radius) {
  return geometry::offset_ring(outline,
                               mostly_counterclockwise(outline) ? radius / 2 : -radius / 2);
}

std::vector<double> thickness_at_nodes(const std::vector<Area>& areas, const Terrain& terrain,
                                       Reach reach) {
  std::vector<double> thickness(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for (const Area& area : areas)
    for_nodes_within(area, terrain, reach, [&](int column, int row) {
      double& h = thickness[terrain.index(column, row)];
      h = h > 0 ? (h + area.thickness) / 2 : area.thickness;
    });
  return thickness;
}

}  // namespace snowshed::methods::slide
