// Areas on the map where a slide is released, entrains snow, or is resisted by forest or buildings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "snowshed/geometry/polygon.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::slide {

/// Coordinates are given from the south-west node of the terrain, m.
struct Area {
  std::string name;
  Polygon polygon;
  double thickness = 0;  // m of snow, normal to the ground; unused for areas of resistance
  /// Instead, for releases: the thickness in the cells around nodes.
  std::shared_ptr<const HeightField> map;
  double max_thickness = 100;  // m, that the map may give
};

struct Areas {
  std::vector<Area> release, entrainment, resistance;
};

/// Distance around an area within which a node still belongs to it.
enum class Reach {
  edge,      // on the outline, except for rounding
  one_cell,  // so near that snow of the area may lie in the node's cell
};

/// Returns the thickness at each node of a grid, 0 outside of the areas. Where areas overlap, each
/// further area gives the mean of its own thickness and of that so far, as in AvaFrame.
std::vector<double> thickness_at_nodes(const std::vector<Area>& areas, const Terrain& terrain,
                                       Reach reach);

/// Returns the outline of an area, widened by half of `radius` as AvaFrame 2.1 does it. The outside
/// follows from the sense of rotation that most corners show as seen from the first one. For some
/// outlines with deep bays this sense is wrong. The result is then narrower than the area.
Ring widened_as_avaframe(const Ring& outline, double radius);

}  // namespace snowshed::slide
