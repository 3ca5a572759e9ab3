#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>
#include <openvdb/tools/LevelSetMeasure.h>

#include "sampling/round_trip_testing.hpp"
#include "snowshed/geometry/readers/vdb_file.hpp"
#include "vdb/vdb_testing.hpp"
#include "write_particles.hpp"

namespace snowshed {
namespace {

using namespace geometry_testing;
using round_trip::voxel;

VdbWriteSettings settings(int dimension) {
  return {dimension, voxel,
          sampling::particle_radius(dimension, voxel, round_trip::per_voxel(dimension)),
          dimension == 2 ? 9 * voxel : 0};
}

ParticleCloud cloud_of(const std::vector<Vec3>& positions) {
  ParticleCloud cloud{positions, std::vector<double>(positions.size(), 0.003), {}};
  std::vector<float> velocity;
  std::vector<std::int32_t> event;
  for (std::size_t n = 0; n < positions.size(); ++n) {
    velocity.insert(velocity.end(), {float(positions[n].x()), 0, float(n)});
    event.push_back(int(n % 7));
  }
  cloud.attributes = {{"velocity", 3, velocity}, {"event", 1, event}};
  return cloud;
}

class WriteVdb : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { openvdb::initialize(); }

  openvdb::GridBase::Ptr grid(const std::string& path, const char* name) const {
    openvdb::io::File file(path);
    file.open();
    return file.readGrid(name);
  }

  const TempDir folder;
  const std::string path = (folder.path() / "snow.vdb").string();
};

TEST_P(WriteVdb, WritesSurfaceDensityAndPoints) {
  const int dimension = GetParam();
  const round_trip::Snow dome = round_trip::dome(dimension);
  const ParticleCloud cloud = cloud_of(round_trip::particles_of(*dome.solid, dimension, 1));
  const double width = dimension == 2 ? settings(dimension).width : 1;
  const VdbSummary summary = write_particles(path, cloud, settings(dimension));

  const auto surface = openvdb::gridPtrCast<openvdb::FloatGrid>(grid(path, "surface"));
  EXPECT_EQ(surface->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_NEAR(surface->voxelSize().x(), voxel / 2, 1e-12);
  EXPECT_NEAR(openvdb::tools::levelSetVolume(*surface) / (dome.volume * width), 1,
              dimension == 2 ? 0.02 : 0.05);
  EXPECT_EQ(summary.surface_voxels, surface->activeVoxelCount());

  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grid(path, "density"));
  EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
  double mass = 0;
  for (auto value = density->cbeginValueOn(); value; ++value) mass += *value * std::pow(voxel, 3);
  EXPECT_NEAR(mass / (0.003 * cloud.positions.size() * width), 1, 1e-6);

  const auto points = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(grid(path, "particles"));
  ASSERT_EQ(openvdb::points::pointCount(points->tree()), cloud.positions.size());
  std::size_t visited = 0;
  for (auto leaf = points->tree().cbeginLeaf(); leaf; ++leaf) {
    const openvdb::points::AttributeHandle<openvdb::Vec3f> at(leaf->constAttributeArray("P"));
    const openvdb::points::AttributeHandle<openvdb::Vec3f> v(leaf->constAttributeArray("v"));
    const openvdb::points::AttributeHandle<std::int32_t> event(leaf->constAttributeArray("event"));
    for (auto index = leaf->beginIndexOn(); index; ++index) {
      const std::size_t n = std::size_t(v.get(*index).z());
      const openvdb::Vec3d x = points->indexToWorld(at.get(*index) + index.getCoord().asVec3d());
      EXPECT_LT((Vec3(x.x(), x.y(), x.z()) - cloud.positions[n]).norm(), 1e-6);
      EXPECT_EQ(event.get(*index), int(n % 7));
      ++visited;
    }
  }
  EXPECT_EQ(visited, cloud.positions.size());
}

TEST_P(WriteVdb, SurvivesARoundTripThroughAFile) {
  const auto through_a_file = [&](const std::vector<Vec3>& particles,
                                  const round_trip::Snow& snow) {
    write_particles(path, cloud_of(particles), settings(snow.dimension));
    return geometry::make_sampled_grid(geometry::read_vdb({path, "surface"}), path);
  };
  round_trip::expect_preserved(round_trip::dome(GetParam()), through_a_file);
  round_trip::expect_preserved(round_trip::slab(GetParam()), through_a_file);
}

TEST_P(WriteVdb, DensityReadBackGivesTheSnow) {
  const int dimension = GetParam();
  const round_trip::Snow slab = round_trip::slab(dimension);
  ParticleCloud cloud = cloud_of(round_trip::particles_of(*slab.solid, dimension, 1));
  for (double& mass : cloud.masses) mass = 200 * slab.volume / double(cloud.masses.size());
  write_particles(path, cloud, settings(dimension));
  const geometry::Shape solid =
      geometry::make_sampled_grid(geometry::read_vdb({path, "density", 100}), path);
  EXPECT_NEAR(sampling::measure(*solid, dimension, voxel) / slab.volume, 1, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, WriteVdb, ::testing::Values(2, 3));

TEST(WriteVdbErrors, RefusesEmptyClouds) {
  openvdb::initialize();
  const TempDir folder;
  const std::string path = (folder.path() / "none.vdb").string();
  expect_input_error([&] { write_particles(path, {}, settings(3)); }, "no particles");
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace snowshed
