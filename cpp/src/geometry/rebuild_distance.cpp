#include "geometry/rebuild_distance.hpp"

#include <cmath>
#include <vector>

#include "geometry/nearest_seed.hpp"
#include "snowshed/support/error.hpp"

namespace snowshed {

void rebuild_distance(GridSamples& samples, double band, const std::string& where) {
  NearestSeed grid(samples.origin, samples.spacing, samples.counts);
  const std::vector<Vec3> surface = zero_crossings(grid, samples.values);
  if (surface.empty()) throw InputError(where, "no value is negative: the solid is empty");
  grid.spread(surface);
  grid.for_each_node([&](const NearestSeed::Index& n) {
    float& value = samples.values[grid.at(n)];
    if (std::abs(value) < band) return;
    const double distance = grid.distance(n);
    value = static_cast<float>(value < 0 ? -distance : distance);
  });
}

}  // namespace snowshed
