// Whether samples on a grid are signed distances: negative inside the solid, metres.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed::geometry {

/// Throws InputError at `where` if the counts do not fit the values, or if a value is not finite.
void require_counts(const GridSamples& samples, const std::string& where);

/// Throws InputError at `where` if no value is negative; if neighbours differ by clearly more than
/// the spacing, because a distance cannot; or if the sign is reversed. The sign counts as reversed
/// if most values at the border of the grid and most at its top are negative, and if in addition
/// none at its bottom is, or the largest value lies neither at the sides nor at the top. The
/// samples must satisfy require_counts.
void require_distances(const GridSamples& samples, const std::string& where);

/// Replaces values that are not distances by distances to the surface (rebuild_distance), and adds
/// a note on the change.
///
/// - Clipped values, as beyond a narrow band, are replaced: values that all neighbours share and
///   that are the largest or the smallest, which does not happen with Euclidean distances.
/// - All values are replaced if their gradient at the surface is below 0.6: they are in another
///   unit, or not distances at all.
///
/// The samples must satisfy require_counts.
void repair_distances(GridSamples& samples, const std::string& where,
                      std::vector<std::string>* notes);

/// Returns the samples on the plane y = 0, which are constant in y. Throws InputError at `where` if
/// the grid does not reach the plane, or if the solid does not.
GridSamples samples_at_y0(const GridSamples& samples, const std::string& where);

}  // namespace snowshed::geometry
