#include "snowshed/methods/slide/areas.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

geometry::Ring widened_as_avaframe(const geometry::Ring& outline, double radius) {
  return geometry::offset_ring(outline,
                               mostly_counterclockwise(outline) ? radius / 2 : -radius / 2);
}

std::vector<double> thickness_at_nodes(const std::vector<Area>& areas, const Terrain& terrain,
                                       Reach reach) {
  std::vector<double> thickness(std::size_t(terrain.columns()) * std::size_t(terrain.rows()), 0.0);
  for (const Area& area : areas) {
    const geometry::Ring ring =
        widened_as_avaframe(scaled(area.polygon.outline, terrain.cell()), radius_of(reach));
    std::vector<geometry::Ring> holes;
    for (const geometry::Ring& hole : area.polygon.holes)
      holes.push_back(scaled(hole, terrain.cell()));
    const geometry::Polygon polygon{ring, std::move(holes)};
    const NodeRange columns = nodes_within(ring, 0, terrain.columns());
    const NodeRange rows = nodes_within(ring, 1, terrain.rows());
    for (int row = rows.begin; row < rows.end; ++row)
      for (int column = columns.begin; column < columns.end; ++column) {
        if (!geometry::contains(polygon, {double(column), double(row)})) continue;
        double& h = thickness[terrain.index(column, row)];
        h = h > 0 ? (h + area.thickness) / 2 : area.thickness;
      }
  }
  return thickness;
}

}  // namespace snowshed::methods::slide
