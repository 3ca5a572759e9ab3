// Areas on the map that a slide begins in, takes snow from, or is held back by.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "snowshed/geometry/polygon.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed {

/// Coordinates are given from the south-west node of the terrain, m.
struct SlideArea {
  std::string name;
  Polygon polygon;
  double thickness = 0;  // m of snow, normal to the ground; unused where there is resistance only
  /// In place of that: the thickness in the cells around nodes. Only of releases.
  std::shared_ptr<const HeightField> map;
};

struct SlideAreas {
  std::vector<SlideArea> release, entrainment, resistance;
};

/// How far around an area a node still belongs to it.
enum class Reach {
  edge,      // on the outline, but for rounding
  one_cell,  // so near that snow of the area may lie in the node's cell
};

/// The thickness of each node of a grid, 0 outside of the areas; where areas overlap, the mean of
/// the sum so far and the next, as AvaFrame has it.
std::vector<double> thickness_at_nodes(const std::vector<SlideArea>& areas, const Terrain& terrain,
                                       Reach reach);

/// The outline of an area as AvaFrame 2.1 widens it: by half of `radius`. It goes by the sense of
/// rotation that most corners show as seen from the first, which for some outlines with deep bays
/// is the wrong one; these become narrower.
Ring widened_as_avaframe(const Ring& outline, double radius);

}  // namespace snowshed
