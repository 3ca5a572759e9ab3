// Patches of faces: their areas and corners, and the pressures on them.
#include "snowshed/methods/pressure_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods {
namespace {

Vec3 normal_at(double tilt) { return {std::sin(radians(tilt)), 0, std::cos(radians(tilt))}; }

TEST(PressureMap, PatchesOfATiltedFaceCoverIt) {
  for (const double tilt : {0.0, 30.0, 45.0, 60.0, 75.0, 90.0, 135.0}) {
    PressureMap map(2, 0.05);
    const Vec3 normal = normal_at(tilt), along(normal.z(), 0, -normal.x());
    for (int k = 0; k < 1000; ++k) map.patch_at(0, 0.001 * k * along, normal);
    double area = 0;
    for (const Patch& patch : map.patches()) {
      area += patch.area;
      const auto corners = map.corners(patch);
      ASSERT_EQ(corners.size(), 2u);
      EXPECT_NEAR((corners[1] - corners[0]).norm(), patch.area, 1e-12);
      for (const Vec3& corner : corners) EXPECT_NEAR(corner.dot(normal), 0, 1e-12);
    }
    EXPECT_GE(area, 0.999) << tilt;
    EXPECT_LE(area, 0.999 + 2 * 0.05 / 0.47) << tilt;
  }
}

TEST(PressureMap, CornersIn3dSpanTheArea) {
  PressureMap map(3, 0.1);
  const Vec3 normal = Vec3(0.5, -0.3, 0.8).normalized();
  const Patch patch = map.patches().at(std::size_t(map.patch_at(2, Vec3(0.31, 0.47, 1.2), normal)));
  const auto corners = map.corners(patch);
  ASSERT_EQ(corners.size(), 4u);
  const Vec3 a = corners[1] - corners[0], b = corners[3] - corners[0];
  EXPECT_NEAR(a.cross(b).norm(), patch.area, 1e-12);
  for (const Vec3& corner : corners)
    EXPECT_NEAR((corner - Vec3(0.31, 0.47, 1.2)).dot(normal), 0, 1e-12);
}

TEST(PressureMap, OppositeFacesHaveTheirOwnPatches) {
  PressureMap map(3, 0.05);
  EXPECT_NE(map.patch_at(0, Vec3::Zero(), Vec3::UnitZ()),
            map.patch_at(0, Vec3::Zero(), -Vec3::UnitZ()));
  EXPECT_NE(map.patch_at(0, Vec3::Zero(), Vec3::UnitZ()),
            map.patch_at(1, Vec3::Zero(), Vec3::UnitZ()));
}

TEST(PressureMap, PeakIsTheMeanOverTenMilliseconds) {
  PressureMap map(2, 0.05);
  const auto patch = map.patch_at(0, Vec3::Zero(), Vec3::UnitZ());
  map.begin_event(0);
  const double dt = 1e-3;
  for (int k = 1; k <= 100; ++k) {  // 20 N for 5 ms, otherwise 4 N
    map.push(patch, dt * (k > 30 && k <= 35 ? 20.0 : 4.0));
    if (map.half_is_over(k * dt)) map.end_half(k * dt);
  }
  EXPECT_NEAR(map.patches()[0].peak, 12 / 0.05, 1e-9);
  EXPECT_NEAR(map.last_pressure(map.patches()[0]), 4 / 0.05, 1e-9);
  double sampled = 0;
  map.sample(0.1, [&](const Patch&, double pressure) { sampled = pressure; });
  EXPECT_NEAR(sampled, (95 * 4 + 5 * 20.0) / 100 / 0.05, 1e-9);
}

class StoredPressureMap : public io::TemporaryFolder {};

TEST_F(StoredPressureMap, ComesBack) {
  PressureMap map(3, 0.05);
  const Vec3 normal = Vec3(0.2, 0.9, 0.1).normalized();
  const auto patch = map.patch_at(1, Vec3(0.3, 0.2, 0.1), normal);
  map.push(patch, 2);
  map.end_half(0.005);
  map.push(patch, 1);
  io::BinaryWriter out;
  map.save(out);
  out.save(path("map"));
  PressureMap read(3, 0.05);
  read.load(io::BinaryReader::load(path("map")), 2);
  ASSERT_EQ(read.patches().size(), 1u);
  EXPECT_EQ(read.patch_at(1, Vec3(0.3, 0.2, 0.1), normal), patch);
  EXPECT_EQ(read.patches()[0].point, map.patches()[0].point);
  EXPECT_EQ(read.patches()[0].area, map.patches()[0].area);
  EXPECT_EQ(read.patches()[0].peak, map.patches()[0].peak);
  EXPECT_THROW(PressureMap(3, 0.05).load(io::BinaryReader::load(path("map")), 1), InputError);
}

}  // namespace
}  // namespace snowshed::methods
