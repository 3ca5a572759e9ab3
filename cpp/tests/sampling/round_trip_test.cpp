// Conversion of particles to a solid and back on snowshed's grids, as between events with "reseed".
#include "sampling/round_trip_testing.hpp"

namespace snowshed::sampling {
namespace {

geometry::Shape on_own_grid(const std::vector<Vec3>& particles, const round_trip::Snow& snow) {
  const double per_voxel = round_trip::per_voxel(snow.dimension);
  return particles_to_level_set(particles, snow.dimension, round_trip::voxel,
                                particle_radius(snow.dimension, round_trip::voxel, per_voxel));
}

class RoundTrip : public ::testing::TestWithParam<int> {};

TEST_P(RoundTrip, KeepsADome) {
  round_trip::expect_preserved(round_trip::dome(GetParam()), on_own_grid);
}
TEST_P(RoundTrip, KeepsASlab) {
  round_trip::expect_preserved(round_trip::slab(GetParam()), on_own_grid);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, RoundTrip, ::testing::Values(2, 3));

}  // namespace
}  // namespace snowshed::sampling
