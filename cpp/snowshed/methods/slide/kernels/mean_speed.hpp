// The speed of the snow around a node, for the peaks of the default mode.
//
// Where snow is thin, the velocity at a node comes from few particles. It depends on where they lie
// in the cell, so it changes with the grid, and it drops to zero beyond the last particle. The
// recorded peak is therefore that of a mean over neighbouring nodes, with binomial weights
// (1 4 6 4 1)/16 along both axes: nearly a Gaussian as wide as a cell, which is isotropic.
//
// This speed fades where the mean mass m falls below a share m_0 of a particle's mass: with the
// mean momentum q it is |q| m / (m^2 + m_0^2).
//
// Nodes beside the snow have a fading speed, too. Otherwise the outermost nodes depend on the
// orientation of the grid, and a rotated slide changes its peak speeds by up to 1.2 (L1) and 1.8
// (L2) times the interpolation error, more than the verification case allows.
#pragma once

#include "snowshed/methods/slide/kernels/node_sums.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// The mean over five values with binomial weights.
SNOWSHED_INLINE Quad binomial_mean(const Quad& a, const Quad& b, const Quad& c, const Quad& d,
                                   const Quad& e) {
  return 0.0625 * (a + e) + 0.25 * (b + d) + 0.375 * c;
}

/// Raises the peak speed along a row of nodes, which may lie up to two rows beyond the rectangle.
SNOWSHED_INLINE void raise_mean_speed(const View& s, int row) {
  const int terrain_row = s.flow_row + row;
  if (terrain_row < 0 || terrain_row >= s.rows) return;
  const auto sums_at = [&](int column, int j) SNOWSHED_INLINE_LAMBDA {
    if (j < 1 || j >= s.cell_rows) return Quad{};  // the first row holds no snow
    return load_row(s.sums + 4 * (std::ptrdiff_t(j) * s.flow_columns + column));
  };
  const auto mean_along_column = [&](int column) SNOWSHED_INLINE_LAMBDA {
    if (column < 0 || column >= s.flow_columns) return Quad{};
    return binomial_mean(sums_at(column, row - 2), sums_at(column, row - 1), sums_at(column, row),
                         sums_at(column, row + 1), sums_at(column, row + 2));
  };
  const double min_square_mass = s.fading_mass * s.fading_mass;
  Quad a{}, b{}, c{}, d = mean_along_column(0);
  for (int column = -1; column < s.flow_columns + 2; ++column) {
    const Quad e = mean_along_column(column + 2);
    const Quad mean = binomial_mean(a, b, c, d, e);
    a = b;
    b = c;
    c = d;
    d = e;
    const int terrain_column = s.flow_column + column;
    const double mass = mean[0];
    if (!(mass > 0) || terrain_column < 0 || terrain_column >= s.columns) continue;
    const double per_mass = mass / (mass * mass + min_square_mass);
    const double square = mean[1] * mean[1] + mean[2] * mean[2] + mean[3] * mean[3];
    raise_speed(s, std::ptrdiff_t(terrain_row) * s.columns + terrain_column,
                square * per_mass * per_mass);
  }
}

SNOWSHED_MODULE_VARIANT_END
