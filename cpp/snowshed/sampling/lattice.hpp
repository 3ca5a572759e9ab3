// Filling a solid with the particles of a lattice, each of which represents a whole cell.
#pragma once

#include <cstddef>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/level_set.hpp"

namespace snowshed::sampling {

/// The particles of a solid.
struct LatticeFilling {
  std::vector<Vec3> positions;  // m, none outside of the solid
  double volume = 0;            // m3 (2D: m2), of the solid
};

/// Fills a bounded solid with points of a square or cubic lattice of the given spacing (m). Their
/// number is the solid's volume in cells, rounded to an integer (`count_lattice`). The solid and
/// its particles then have the same volume, for any spacing.
///
/// In a box the lattice stands along its edges. Its full layers begin at the lowest corner, and a
/// partial layer is at the top. Other solids have a lattice along the world axes, which begins at
/// the lowest corner of their bounds. Cells that the surface cuts share points by volume: they get
/// as many points as their parts within the solid would fill whole cells. Along a face that halves
/// the cells, every second cell has a point. A point outside the solid is moved to the surface.
///
/// Throws InputError if the solid holds less than half a cell, or more than `max_particles`, and
/// Stopped on request.
LatticeFilling fill_lattice(const geometry::LevelSet& shape, int dimension, double spacing,
                            const StopRequest& stop = {});

/// Returns the number of points that `fill_lattice` places. Throws as `fill_lattice` does.
std::size_t count_lattice(const geometry::LevelSet& shape, int dimension, double spacing,
                          const StopRequest& stop = {});

}  // namespace snowshed::sampling
