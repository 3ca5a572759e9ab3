#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <limits>

#include "snowshed/sampling/voxel_set.hpp"
#include "snowshed/scene/build_shape.hpp"
#include "vdb/vdb_testing.hpp"

namespace snowshed {
namespace {

using namespace geometry_testing;
using namespace vdb_testing;

constexpr float radius = 0.5f, voxel = 0.05f;
const Vec3 center(0.3, -0.2, 0.7);

openvdb::FloatGrid::Ptr sphere(float band = 3) {
  openvdb::initialize();
  return named(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                   radius, {float(center.x()), float(center.y()), float(center.z())}, voxel, band),
               "ball");
}

openvdb::FloatGrid::Ptr fog() {
  auto grid = sphere();
  openvdb::tools::sdfToFogVolume(*grid);  // 1 deep inside, 0 on the surface
  return named(grid, "mist");
}

TEST(ReadVdb, LevelSetsGiveDistancesEverywhere) {
  const TempDir folder;
  const std::string path = write(folder, {sphere()});
  for (const char* name : {"", "ball"}) {
    const geometry::Shape ball =
        geometry::make_sampled_grid(geometry::read_vdb({path, name}), "ball");
    // With ten voxels along the radius, linear interpolation loses half a per cent.
    EXPECT_NEAR(sampling::measure(*ball, 3, voxel) / (4 * pi / 3 * std::pow(radius, 3)), 1, 0.01);
    // From the centre, ten voxels deep, to points outside the stored box.
    for (const double fraction : {0.01, 0.3, 0.6, 0.95, 1.0, 1.05, 1.2}) {
      const Vec3 x = center + fraction * radius * Vec3(1, 2, -2) / 3;
      EXPECT_NEAR(ball->distance(x), (fraction - 1) * radius, 0.1 * voxel) << fraction;
      if (fraction > 0.1) EXPECT_LT((ball->normal(x) - Vec3(1, 2, -2) / 3).norm(), 0.1) << fraction;
    }
  }
}

TEST(ReadVdb, ReadsHalfPrecisionAndScales) {
  const TempDir folder;
  auto grid = sphere();
  grid->setSaveFloatAsHalf(true);
  const geometry::VdbSource centimetres{write(folder, {grid}), "ball", 0.5, 0.01};
  const geometry::Shape ball = make_sampled_grid(read_vdb(centimetres), "ball");
  EXPECT_NEAR(ball->distance(0.01 * (center + Vec3(0.6, 0, 0))), 0.001, 2e-5);
}

TEST(ReadVdb, FogVolumeIsSnowAboveTheThreshold) {
  const TempDir folder;
  const std::string path = write(folder, {fog()});
  // The value grows from 0 to 1 over three voxels.
  for (const double threshold : {0.2, 0.5, 0.8}) {
    const geometry::Shape ball =
        geometry::make_sampled_grid(geometry::read_vdb({path, "mist", threshold}), "mist");
    const double expected = radius - 3 * voxel * threshold;
    const double volume = sampling::measure(*ball, 3, voxel);
    EXPECT_NEAR(std::cbrt(volume * 3 / 4 / pi), expected, 0.25 * voxel) << threshold;
    EXPECT_NEAR(ball->distance(center + Vec3(0, 0, 1)), 1 - expected, 0.25 * voxel);
  }
}

TEST(ReadVdb, BuildsAShapeOfAScene) {
  const TempDir folder;
  write(folder, {sphere(), fog()});
  scene::ShapeSpec spec;
  spec.type = "vdb";
  spec.file = "test.vdb";
  spec.grid = "ball";
  EXPECT_NEAR(scene::build_shape(spec, 3, "/x", folder.path())->distance(center), -radius,
              0.1 * voxel);
  // In 2D the shape is its section with the plane y = 0, which is 0.2 m from the centre.
  const double section = std::sqrt(radius * radius - 0.04);
  EXPECT_NEAR(sampling::measure(*scene::build_shape(spec, 2, "/x", folder.path()), 2, voxel),
              pi * section * section, 0.02);
}

TEST(ReadVdb, RefusesOtherThanUniformScalarGrids) {
  const TempDir folder;
  openvdb::initialize();
  const auto refused = [&](const openvdb::GridBase::Ptr& grid, const std::string& why,
                           const std::string& name = "") {
    const std::string path = write(folder, {grid});
    expect_input_error([&] { geometry::read_vdb({path, name}); }, path);
    expect_input_error([&] { geometry::read_vdb({path, name}); }, why);
  };
  const auto vectors = openvdb::Vec3SGrid::create();
  vectors->setName("velocity");
  vectors->tree().setValueOn({0, 0, 0}, openvdb::Vec3s(1));
  refused(vectors, "no grid of floats; the file holds 'velocity' (Tree_vec3s_5_4_3)");
  refused(vectors, "grid 'velocity': a grid of type Tree_vec3s_5_4_3; allowed: Tree_float_5_4_3",
          "velocity");
  refused(sphere(), "grid 'cube': no such grid; the file holds 'ball' (Tree_float_5_4_3)", "cube");
  auto grid = sphere();
  grid->setGridClass(openvdb::GRID_UNKNOWN);
  refused(grid, "class 'unknown'; allowed: level set, fog volume");
  grid = sphere();
  grid->transform().postRotate(0.1);
  refused(grid, "not cubes along the axes");
  grid = sphere();
  grid->transform().postScale(openvdb::Vec3d(1, 1, 2));
  refused(grid, "not cubes along the axes");
  grid = sphere();
  grid->transform().postScale(100.0);  // distances and positions in different units
  refused(grid, "background");
  refused(openvdb::createLevelSet<openvdb::FloatGrid>(0.1, 3), "no active voxels");
  const std::string pair = write(folder, {sphere(), fog()});
  expect_input_error([&] { geometry::read_vdb({pair, ""}); },
                     "more than one grid of floats; give the name");
}

TEST(ReadVdb, RefusesHugeExtents) {
  const TempDir folder;
  auto grid = sphere();
  grid->tree().setValueOn({2'000'000'000, 0, 0}, 0.1f);
  grid->tree().setValueOn({-2'000'000'000, 0, 2'000'000'000}, 0.1f);
  const std::string far = write(folder, {grid});
  expect_input_error([&] { geometry::read_vdb({far, "ball"}); }, "at most 5e+07 are read");
  // A single active tile covers a large part of index space.
  grid = openvdb::FloatGrid::create(0.0f);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->tree().root().addTile(openvdb::Coord(0), 1.0f, true);
  const std::string wide = write(folder, {grid});
  expect_input_error([&] { geometry::read_vdb({wide, ""}); }, "at most 5e+07 are read");
}

TEST(ReadVdb, RefusesNonFiniteValues) {
  const TempDir folder;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto grid = sphere();
    for (auto value = grid->beginValueOn(); value; ++value) value.setValue(bad);
    const std::string path = write(folder, {grid});
    expect_input_error([&] { geometry::read_vdb({path, "ball"}); },
                       path + ": grid 'ball': the value at");
    const std::string empty = write(folder, {openvdb::createLevelSet<openvdb::FloatGrid>(bad, 3)});
    expect_input_error([&] { geometry::read_vdb({empty, ""}); }, empty);
  }
}

TEST(ReadVdb, TooSteepValuesAreRebuilt) {
  const TempDir folder;
  auto grid = sphere();
  for (auto value = grid->beginValueOn(); value; ++value) value.setValue(100.0f * *value);
  const geometry::Shape ball =
      geometry::make_sampled_grid(geometry::read_vdb({write(folder, {grid}), ""}), "ball");
  for (const double fraction : {0.5, 0.9, 1.1, 1.5})
    EXPECT_NEAR(ball->distance(center + fraction * radius * Vec3::UnitX()), (fraction - 1) * radius,
                0.35 * voxel);
}

TEST(ReadVdb, RefusesDamagedFiles) {
  const TempDir folder;
  expect_input_error([] { geometry::read_vdb({"/no/such.vdb", ""}); }, "no such file");
  expect_input_error([&] { geometry::read_vdb({folder.write("none", ""), ""}); }, "ends too early");
  expect_input_error(
      [&] { geometry::read_vdb({folder.write("text", std::string(5000, 'x')), ""}); },
      "not a sound OpenVDB file");
  const std::string path = write(folder, {sphere()});
  std::ifstream stream(path, std::ios::binary);
  const std::string intact{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t tenths = 1; tenths < 10; ++tenths) {
    const auto truncated = folder.write("cut.vdb", intact.substr(0, intact.size() * tenths / 10));
    expect_input_error([&] { geometry::read_vdb({truncated, "ball"}); }, "cut.vdb: grid 'ball': ");
  }
}

// A damaged file must be read or refused within a short time, and must not crash this process.
TEST(ReadVdb, SurvivesFlippedBytes) {
  const TempDir folder;
  const std::string path = write(folder, {sphere()});
  std::ifstream stream(path, std::ios::binary);
  const std::string intact{std::istreambuf_iterator<char>(stream), {}};
  Random random(11);
  for (int n = 0; n < 20; ++n) {
    std::string damaged = intact;
    // Every other file is damaged in the headers at its beginning.
    const std::size_t reach = n % 2 ? damaged.size() : 700;
    for (int flips = 0; flips < 3; ++flips)
      damaged[std::size_t(random.uniform() * reach)] = char(random.uniform() * 256);
    const auto file = folder.write("flipped.vdb", damaged);
    try {
      geometry::make_sampled_grid(geometry::read_vdb({file, ""}), "flipped.vdb");
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("flipped.vdb"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace snowshed
