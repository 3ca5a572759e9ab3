// Wall particles of surfaces that are not plane: terrain and an obstacle of triangles, in 3D.
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/mesh_testing.hpp"
#include "mps_testing.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"
#include "snowshed/geometry/mesh_shells.hpp"

namespace snowshed::methods::mps {
namespace {

using geometry_testing::sphere_mesh;

constexpr double bump = 0.01;  // m, largest height and depth of the ground

/// Ground with bumps, 0.2 m long along both axes, from -0.1 to `edge` + 0.1 m.
geometry::TriangleMesh bumpy_ground(double edge) {
  constexpr std::uint32_t cells = 12;
  constexpr double wave = 2 * 3.14159265358979 / 0.2;
  geometry::TriangleMesh mesh;
  const std::uint32_t side = cells + 1, layer = side * side;
  for (const bool top : {false, true})
    for (std::uint32_t j = 0; j < side; ++j)
      for (std::uint32_t i = 0; i < side; ++i) {
        const double x = -0.1 + (edge + 0.2) * i / cells, y = -0.1 + (edge + 0.2) * j / cells;
        mesh.vertices.emplace_back(x, y,
                                   top ? bump * std::sin(wave * x) * std::sin(wave * y) : -0.2);
      }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * side + i;
      quad(layer + a, layer + a + 1, layer + a + side + 1, layer + a + side);
      quad(a, a + side, a + side + 1, a + 1);
    }
  for (std::uint32_t k = 0; k < cells; ++k) {
    const std::uint32_t last = cells * side, right = cells;
    quad(k, k + 1, layer + k + 1, layer + k);
    quad(last + k + 1, last + k, layer + last + k, layer + last + k + 1);
    quad((k + 1) * side, k * side, layer + k * side, layer + (k + 1) * side);
    quad(k * side + right, (k + 1) * side + right, layer + (k + 1) * side + right,
         layer + k * side + right);
  }
  return mesh;
}

Obstacle mesh_obstacle(const char* name, geometry::TriangleMesh mesh) {
  return {name,
          geometry::make_mesh(geometry::merged_layers(geometry::solid_of_shells(mesh, name))),
          {Condition::sticky, 0.0},
          std::nullopt};
}

/// A tank with bumpy ground.
Options bumpy_tank(double width) {
  Options o = tank(3, width, 0.02);
  o.settings.walls = Walls::particles;
  o.obstacles.front() = mesh_obstacle("ground", bumpy_ground(width));
  return o;
}

/// A block without the particles that would be nearer to the obstacles than half a spacing.
ParticleBatch block_outside(const Options& o, const Vec3& low, const Vec3& high) {
  ParticleBatch batch = block_of(o, low, high);
  const auto inside = [&](const Vec3& x) {
    return std::any_of(o.obstacles.begin(), o.obstacles.end(), [&](const Obstacle& obstacle) {
      return obstacle.shape->distance(x) < 0.5 * o.settings.spacing - 1e-9;
    });
  };
  batch.positions.erase(std::remove_if(batch.positions.begin(), batch.positions.end(), inside),
                        batch.positions.end());
  return batch;
}

/// Smallest distance of a particle from an obstacle, m.
double nearest_distance(const Method& method, const Options& o) {
  double min_distance = HUGE_VAL;
  for (const Vec3& x : method.state().positions)
    for (const Obstacle& obstacle : o.obstacles)
      min_distance = std::min(min_distance, obstacle.shape->distance(x));
  return min_distance;
}

// The depth of the water follows from its volume, because the ground's mean height is zero.
TEST(MpsMeshWalls, HoldWaterAtRestOnBumpyGround) {
  constexpr double edge = 0.2;
  Options o = bumpy_tank(edge);
  o.settings.viscosity = 1;
  const auto mps = make_solver(o);
  mps->add(block_outside(o, {0, 0, -0.02}, {edge, edge, 0.16}));
  const std::size_t count = mps->size();
  while (mps->time() < 0.5) mps->step();
  double height = 0;
  for (const Vec3& x : mps->state().positions) height += x.z() / double(count);
  const double depth = double(count) * std::pow(o.settings.spacing, 3) / (edge * edge);
  EXPECT_NEAR(height, 0.5 * (depth - 0.25 * bump * bump / depth), 0.02 * depth);
  EXPECT_LT(mps->motion(0).rms_speed, 0.02 * std::sqrt(9.81 * depth));
  EXPECT_GT(nearest_distance(*mps, o), 0);
  EXPECT_EQ(mps->size(), count);
}

TEST(MpsMeshWalls, StopAllSnow) {
  Options o = bumpy_tank(0.4);
  o.settings.rheology = ShearLaw::bingham_dilatant;
  o.settings.density = 200;
  o.settings.viscosity = 0.012;
  geometry::TriangleMesh ball = sphere_mesh(0.06, 6);
  for (Vec3& x : ball.vertices) x += Vec3(0.22, 0.2, 0.05);
  o.obstacles.push_back(mesh_obstacle("ball", ball));
  const auto mps = make_solver(o);
  ParticleBatch snow = block_outside(o, {0, 0.1, 0}, {0.14, 0.3, 0.2});
  snow.velocity = {2, 0, 0};
  mps->add({snow});
  double min_distance = HUGE_VAL;
  while (mps->time() < 0.15) {
    mps->step();
    min_distance = std::min(min_distance, nearest_distance(*mps, o));
  }
  EXPECT_GT(min_distance, 0);
  EXPECT_EQ(mps->size(), snow.positions.size());
}

}  // namespace
}  // namespace snowshed::methods::mps
