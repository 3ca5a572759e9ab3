// The columns of snow whose weight presses on the ground.
//
// The snow's centre of mass lies half a column above the ground. With the thickness h normal to the
// ground, the volume of snow over its area, a column along the unit vector e is h/(e n) long, so
// that its potential energy is m g f h/2 with f = e_z/(e n). The forces of pressure follow from
// this energy.
//
// - Vertical columns, f = 1/n_z: snow with a level surface rests on ground of any shape.
// - Columns across the flow u, e ~ z - (z u) u/u^2, f = (1 - u_z^2/u^2)/n_z: f = n_z for snow that
//   flows down the fall line, as for a thin layer (Savage and Hutter 1989), and a level surface
//   across a gully along which snow flows.
#pragma once

#include "snowshed/core/variant.hpp"

namespace snowshed::methods::slide {

/// Slower snow has columns that turn from across the flow to normal to the ground, m/s.
inline constexpr double min_flow_speed = 0.1;

/// The factor f for ground with the vertical component `nz` of its normal.
SNOWSHED_INLINE double vertical_column_factor(double nz) { return 1 / nz; }
SNOWSHED_INLINE double across_flow_column_factor(double nz, double ux, double uy, double uz) {
  const double slow = min_flow_speed * min_flow_speed;
  const double steepness = (uz * uz + slow * (1 - nz * nz)) / (ux * ux + uy * uy + uz * uz + slow);
  return (1 - steepness) / nz;
}

SNOWSHED_INLINE double column_factor(bool across_flow, double nz, double ux, double uy, double uz) {
  return across_flow ? across_flow_column_factor(nz, ux, uy, uz) : vertical_column_factor(nz);
}

}  // namespace snowshed::methods::slide
