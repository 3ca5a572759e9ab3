// The snow on the nodes of the grid, from the masses and momenta of particles, which add to the
// four nodes around them.
#pragma once

#include "snowshed/methods/slide/kernels/cell_positions.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// The two nodes on one side of a cell.
struct NodePair {
  Quad south, north;
};

/// Adds the mass and momentum of a cell's particles to the nodes in the west and in the east, and
/// copies the values that their neighbours will read.
SNOWSHED_INLINE void add_to_nodes(const View& s, std::uint32_t begin, std::uint32_t end,
                                  NodePair& west, NodePair& east) {
  for (std::uint32_t e = begin; e < end; ++e) {
    const std::uint32_t i = s.sorted_particle[e];
    const double mass = s.mass[i];
    s.sorted_x[e] = s.x[i];
    s.sorted_y[e] = s.y[i];
    if (s.sorted_z) s.sorted_z[e] = s.z[i];
    s.sorted_mass[e] = mass;
    const Quad carried{mass, mass * s.ux[i], mass * s.uy[i], mass * s.uz[i]};
    const Quad to_east = s.east[i] * carried, to_west = carried - to_east;
    const Quad north_east = s.north[i] * to_east, north_west = s.north[i] * to_west;
    west.south += to_west - north_west;
    west.north += north_west;
    east.south += to_east - north_east;
    east.north += north_east;
  }
}

/// Raises the peak speed at a node of the terrain to a speed, given by its square.
SNOWSHED_INLINE void raise_speed(const View& s, std::ptrdiff_t node, double square) {
  if (square > s.peak_speed[node] * s.peak_speed[node]) s.peak_speed[node] = std::sqrt(square);
}

/// Turns the sums of a row of nodes into thickness and velocity, and raises the peaks.
SNOWSHED_INLINE void finish_nodes(const View& s, int row) {
  double* record = s.nodes + 4 * std::ptrdiff_t(row) * s.flow_columns;
  const std::ptrdiff_t first =
      std::ptrdiff_t(s.flow_row + row) * s.columns + s.flow_column;  // in the terrain
  for (int column = 0; column < s.flow_columns; ++column, record += 4) {
    const Quad sums = load_row(record);
    if (s.sums) store_row(s.sums + (record - s.nodes), sums);
    const double mass = sums[0];
    if (!(mass > 0)) continue;
    const std::ptrdiff_t node = first + column;
    const double column_mass = s.ground[4 * node + 3] * s.density;  // kg/m
    const double share = 1 / (mass * column_mass);
    Quad flow = (share * column_mass) * sums;
    const double square = flow[1] * flow[1] + flow[2] * flow[2] + flow[3] * flow[3];
    const double thickness = mass * (share * mass);
    flow[0] = thickness;
    store_row(record, flow);
    if (!s.peak_thickness) continue;
    if (thickness > s.peak_thickness[node]) s.peak_thickness[node] = thickness;
    if (!s.sums) raise_speed(s, node, square);
  }
}

/// Adds the sums of a row of cells to the rows of nodes south and north of it. All even rows come
/// first, and begin the sums of all nodes. The odd rows add to the sums and finish them.
SNOWSHED_INLINE void sum_on_nodes(const View& s, int row) {
  const bool begins = row % 2 == 0, has_north = row + 1 < s.cell_rows;
  double* south = s.nodes + 4 * std::ptrdiff_t(row) * s.flow_columns;
  double* north = south + 4 * std::ptrdiff_t(s.flow_columns);
  const std::uint32_t* begin = s.cell_begin + std::ptrdiff_t(row) * s.cell_columns;
  NodePair west{};
  for (int column = 0; column < s.cell_columns; ++column) {
    NodePair east{};
    add_to_nodes(s, begin[column], begin[column + 1], west, east);
    const std::ptrdiff_t at = 4 * std::ptrdiff_t(column);
    store_row(south + at, begins ? west.south : Quad(load_row(south + at) + west.south));
    if (has_north)
      store_row(north + at, begins ? west.north : Quad(load_row(north + at) + west.north));
    west = east;
  }
  if (begins) return;
  finish_nodes(s, row);
  if (has_north) finish_nodes(s, row + 1);
}

SNOWSHED_MODULE_VARIANT_END
