// Signed distances that a file does not contain: outside the narrow band of a level set, and in a
// density.
#pragma once

#include <string>

#include "snowshed/geometry/sampled_grid.hpp"

namespace snowshed::geometry {

/// Magnitudes beyond which values are no distances, metres.
struct Band {
  double outside, inside;  // the solid
};

/// Replaces values whose magnitude is that of the band or more by signed distances to the surface,
/// on which the values change sign. Their signs stay. All values are replaced if the band is 0, or
/// if the values change sign more steeply than a distance can.
///
/// Only the crossings of the surface with the edges of the grid are known. Rebuilt distances are
/// therefore too large: by at most a third of the spacing, and by at most a fifth at three
/// spacings and beyond.
///
/// Throws InputError at `where` if the values do not change sign.
void rebuild_distance(GridSamples& samples, Band band, const std::string& where);
inline void rebuild_distance(GridSamples& samples, double band, const std::string& where) {
  rebuild_distance(samples, Band{band, band}, where);
}

}  // namespace snowshed::geometry
