// Areas on the map where a slide is released, entrains snow, or is resisted by forest or buildings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "snowshed/geometry/polygon.hpp"
#include "snowshed/methods/slide/dams.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

/// Coordinates are given from the south-west node of the terrain, m.
struct Area {
  std::string name;
  geometry::Polygon polygon;
  double thickness = 0;  // m of snow, normal to the ground; unused for areas of resistance
  /// For releases, in place of `thickness`: a raster with the thickness in the cell around each
  /// node. In the compatible mode its nodes are nodes of the terrain.
  std::shared_ptr<const geometry::HeightField> map;
  double max_thickness = 100;  // m, that the map may give
};

/// Snow that enters an area at one time.
struct Pulse {
  double time, thickness, speed;  // s; m, normal to the ground; m/s down the slope
};

/// An area that snow enters at given times.
struct Inflow {
  Area area;
  bool bonds = false;
  std::vector<Pulse> pulses;
};

struct Areas {
  std::vector<Area> release, secondary_release, entrainment, resistance;
  std::vector<Inflow> inflows;
  std::vector<Dam> dams;
  double release_speed = 0;  // m/s down the slope
};

/// Distance around an area within which a node still belongs to it.
enum class Reach {
  edge,      // on the outline, except for rounding
  one_cell,  // near enough for snow of the area to lie in the node's cell
};

/// Returns the thickness at each node of a grid, 0 outside of the areas. Where areas overlap, the
/// thickness becomes the mean of its value so far and that of the next area, as in AvaFrame.
std::vector<double> thickness_at_nodes(const std::vector<Area>& areas, const Terrain& terrain,
                                       Reach reach);

/// Returns the thickness in a cell of an area's raster. Throws InputError, which names `path`, if
/// it is missing or not above 0, or larger than the area accepts.
double thickness_in_cell(const Area& area, const Terrain& terrain, int column, int row,
                         const std::string& path);

/// Returns the thickness of the released snow at each node, 0 outside of the release. In the
/// compatible mode, snow of polygons reaches one cell beyond them, and snow of a raster is at the
/// nodes within the polygons. Throws InputError if such a raster has other nodes than the terrain,
/// or no valid thickness within the polygons.
std::vector<double> released_at_nodes(const std::vector<Area>& release, const Terrain& terrain,
                                      Mode mode);

/// Returns the outline of an area, widened by half of `radius` as AvaFrame 2.1 does it. The outline
/// moves to the side that follows from the sense in which most corners are passed, as seen from the
/// first one. For some outlines with deep bays this sense is wrong, and the result is narrower than
/// the area.
geometry::Ring widened_as_avaframe(const geometry::Ring& outline, double radius);

}  // namespace snowshed::methods::slide
