// Signed distances where a file has none: beyond a narrow band, or all over a density.
#pragma once

#include <string>

#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed {

/// Replaces the values of magnitude `band` or more (0: all of them) by distances to the surface
/// where the values change sign; their signs stay. So are all values that change sign more steeply
/// than distances can. The surface is known at its crossings with the
/// edges of the grid, so that rebuilt distances are too large, by a third of the spacing at most,
/// by a fifth from three spacings away on.
///
/// Throws InputError at `where` if the values do not change sign.
void rebuild_distance(GridSamples& samples, double band, const std::string& where);

}  // namespace snowshed
