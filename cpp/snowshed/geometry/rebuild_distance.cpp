#include "snowshed/geometry/rebuild_distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/nearest_seed.hpp"

namespace snowshed::geometry {
namespace {

using Index = NearestSeed::Index;

double at(const Band& band, double value) { return value < 0 ? band.inside : band.outside; }

/// Lowers each rebuilt magnitude that exceeds a neighbour's by more than the spacing. Without this,
/// values of a file that are not quite distances would make a step at the edge of the band.
void limit_slope(GridSamples& samples, const NearestSeed& grid, const Band& band) {
  const auto lower = [&](const Index& n, int step) {
    float& value = samples.values[grid.at(n)];
    if (std::abs(value) < at(band, value)) return;
    for (const Index& from :
         {Index{n.i + step, n.j, n.k}, {n.i, n.j + step, n.k}, {n.i, n.j, n.k + step}}) {
      if (!grid.contains(from)) continue;
      const double limit = std::abs(samples.values[grid.at(from)]) + samples.spacing;
      if (std::abs(value) > limit) value = static_cast<float>(std::copysign(limit, value));
    }
  };
  for (int round = 0; round < 2; ++round) {
    grid.for_each_node([&](const Index& n) { lower(n, -1); });
    grid.for_each_node_backwards([&](const Index& n) { lower(n, 1); });
  }
}

/// Returns whether values change sign more steeply than a distance can.
bool cross_too_steeply(const GridSamples& samples, const NearestSeed& grid) {
  bool jumps = false;
  grid.for_each_edge([&](const Index& n, const Index& next) {
    const double value = samples.values[grid.at(n)], other = samples.values[grid.at(next)];
    jumps |= (value < 0) != (other < 0) && std::abs(other - value) > 1.5 * samples.spacing;
  });
  return jumps;
}

}  // namespace

void rebuild_distance(GridSamples& samples, Band band, const std::string& where) {
  NearestSeed grid(samples.origin, samples.spacing, samples.counts);
  const std::vector<Vec3> surface = zero_crossings(grid, samples.values);
  if (surface.empty()) throw InputError(where, "no value is negative: the solid is empty");
  grid.propagate(surface);
  if (cross_too_steeply(samples, grid)) band = {0, 0};  // no value is a distance
  grid.for_each_node([&](const Index& n) {
    float& value = samples.values[grid.at(n)];
    const double trusted = at(band, value);
    if (std::abs(value) < trusted) return;
    const double distance = std::max(trusted, grid.distance(n));
    value = static_cast<float>(value < 0 ? -distance : distance);
  });
  if (band.outside > 0) limit_slope(samples, grid, band);
}

}  // namespace snowshed::geometry
