#include "snowshed/methods/mps/wall_particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "mps_testing.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

template <int D>
Particles<D> at_rest(const std::vector<Vec3>& positions) {
  Particles<D> p;
  p.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    p.position[i] = section<D>(positions[i]);
    p.velocity[i].setZero();
    p.pressure_acceleration[i].setZero();
    p.viscous_acceleration[i].setZero();
    p.kind[i] = Kind::moving;
    p.event[i] = 0;
  }
  return p;
}

/// Appends the wall particles to the snow, and finds its neighbours.
template <int D>
void append_walls(const Model<D>& model, Particles<D>& p, Workspace<D>& work) {
  work.walls = WallParticles<D>(model.options.obstacles, model.settings().spacing, model.reach());
  work.walls.append_near(0, model.options.period, model.particle_mass(), p);
  find_neighbours(model, p, 0.0, work);
}

/// z of the highest wall particle that bears pressure, m.
template <int D>
double highest_inner_wall(const Options& o, Particles<D> p) {
  const Model<D> model(o);
  Workspace<D> work;
  append_walls(model, p, work);
  double z = -HUGE_VAL;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.kind[i] == Kind::inner_wall) z = std::max(z, p.position[i][D - 1]);
  return z;
}

/// The smallest and the largest number density of snow and inner walls, relative to a lattice.
template <int D>
std::pair<double, double> densities(const Options& o, Particles<D> p) {
  const Model<D> model(o);
  Workspace<D> work;
  append_walls(model, p, work);
  double min_density = HUGE_VAL, max_density = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.kind[i] == Kind::dummy_wall) continue;
    min_density = std::min(min_density, work.near.density[i] / model.kernel.number_density);
    max_density = std::max(max_density, work.near.density[i] / model.kernel.number_density);
  }
  return {min_density, max_density};
}

// Wall particles continue a lattice of snow in a corner: no point is missing, and none is occupied
// twice.
TEST(MpsWallParticles, ContinueTheLatticeOfTheSnow) {
  for (const int dimension : {2, 3}) {
    Options o = tank(dimension, 0.08, 0.01);
    o.settings.walls = Walls::particles;
    o.obstacles.push_back(wall({0, 0, 0.08}, -Vec3::UnitZ()));  // full
    const ParticleBatch batch = block_of(o, Vec3::Zero(), {0.08, 0.08, 0.08});
    const auto [low, high] = dimension == 2 ? densities<2>(o, at_rest<2>(batch.positions))
                                            : densities<3>(o, at_rest<3>(batch.positions));
    EXPECT_NEAR(low, 1, 1e-5) << dimension;
    EXPECT_NEAR(high, 1, 1e-5) << dimension;
  }
}

// The surface is half a spacing above the topmost snow: the next wall particle is above it.
TEST(MpsWallParticles, BearPressureUpToTheSurfaceOnly) {
  for (const int dimension : {2, 3}) {
    const double spacing = 0.02, height = 0.1;
    Options o = tank(dimension, height, spacing);
    o.settings.walls = Walls::particles;
    const ParticleBatch batch = block_of(o, Vec3::Zero(), Vec3::Constant(height));
    const double top = dimension == 2 ? highest_inner_wall<2>(o, at_rest<2>(batch.positions))
                                      : highest_inner_wall<3>(o, at_rest<3>(batch.positions));
    EXPECT_NEAR(top, height - 0.5 * spacing, 1e-9) << dimension;
  }
}

// The wall particles of a plane form a lattice that is aligned with it.
TEST(MpsWallParticles, CoverAnInclineEvenly) {
  Options o = tank(2, 1, 0.01);
  o.settings.walls = Walls::particles;
  const Vec3 normal = Vec3(0.6, 0, 0.8), along(0.8, 0, -0.6);
  o.obstacles = {wall(Vec3::Zero(), normal)};
  std::vector<Vec3> row;
  for (int i = -10; i < 10; ++i) row.push_back((i + 0.5) * 0.01 * along + 0.005 * normal);
  Particles<2> p = at_rest<2>(row);
  WallParticles<2> walls(o.obstacles, 0.01, 0.021);
  walls.append_near(0, 0, 1, p);
  int covered = 0;
  for (std::size_t i = row.size(); i < p.size(); ++i) {
    const double depth = -embed(p.position[i]).dot(normal) / 0.01;
    EXPECT_NEAR(depth - std::floor(depth), 0.5, 1e-9);
    EXPECT_EQ(p.kind[i] == Kind::inner_wall, depth < 1);
    covered += std::abs(embed(p.position[i]).dot(along)) < 0.1 && depth < 1;
  }
  EXPECT_EQ(covered, 20);
}

// On curved walls the points of a lattice are moved onto layers, where they would crowd.
TEST(MpsWallParticles, DoNotCrowdInTheLayersOfABall) {
  constexpr double spacing = 0.01, radius = 0.06;
  Options o = tank(3, 1, spacing);
  o.obstacles = {{"ball",
                  geometry::make_sphere(Vec3::Zero(), radius),
                  {Condition::sticky, 0.0},
                  std::nullopt}};
  ParticleBatch surroundings = block_of(o, Vec3::Constant(-0.08), Vec3::Constant(0.08));
  std::vector<Vec3> snow;
  for (const Vec3& x : surroundings.positions)
    if (x.norm() > radius + 0.5 * spacing) snow.push_back(x);
  Particles<3> p = at_rest<3>(snow);
  WallParticles<3> walls(o.obstacles, spacing, 2.1 * spacing);
  walls.append_near(0, 0, 1, p);
  double min_separation = HUGE_VAL;
  for (std::size_t i = snow.size(); i < p.size(); ++i) {
    const double depth = (radius - p.position[i].norm()) / spacing;
    EXPECT_NEAR(depth - std::floor(depth), 0.5, 1e-9);
    for (std::size_t j = i + 1; j < p.size(); ++j)
      min_separation = std::min(min_separation, (p.position[i] - p.position[j]).norm());
  }
  const double area = 4 * 3.14159265358979 * (radius - 0.5 * spacing) * (radius - 0.5 * spacing);
  const auto inner = std::count(p.kind.begin(), p.kind.end(), Kind::inner_wall);
  EXPECT_GT(min_separation, 0.7 * spacing);
  EXPECT_NEAR(double(inner) * spacing * spacing, area, 0.1 * area);
}

// A wall thinner than a particle has a single layer, through which no pressure goes.
TEST(MpsWallParticles, LieInTheMiddleOfAThinBoard) {
  Options o = tank(2, 1, 0.01);
  o.obstacles = {{"board",
                  geometry::make_box(Vec3(0.05, 0, 0.05), Vec3(0.002, 2, 0.1)),
                  {Condition::sticky, 0.0},
                  std::nullopt}};
  Particles<2> p = at_rest<2>({{0.03, 0, 0.05}, {0.07, 0, 0.05}});
  WallParticles<2> walls(o.obstacles, 0.01, 0.021);
  walls.append_near(0, 0, 1, p);
  ASSERT_GT(p.size(), 6u);
  for (std::size_t i = 2; i < p.size(); ++i) {
    EXPECT_NEAR(p.position[i][0], 0.05, 1e-9);
    EXPECT_EQ(p.kind[i], Kind::dummy_wall);
  }
  remove_walls(p);
  EXPECT_EQ(p.size(), 2u);
}

// The wall of a bin has particles on both sides, no matter how thick the block was from which it
// was cut.
TEST(MpsWallParticles, LieAlongTheThinWallsOfACombinedSolid) {
  const double spacing = 0.01, wall = 0.004;
  const geometry::Shape bin = geometry::subtract(
      geometry::make_box(Vec3(0, 0, 0.2), Vec3(0.6, 10, 0.4)),
      {geometry::make_box(Vec3(0, 0, 0.2 + wall), Vec3(0.6 - 2 * wall, 11, 0.4))});
  Options o = tank(2, 1, spacing);
  o.settings.walls = Walls::particles;
  o.obstacles = {{"bin", bin, {Condition::sticky, 0.0}, std::nullopt}};
  const Model<2> model(o);
  EXPECT_NEAR(model.options.obstacles.front().shape->distance({0, 0, wall / 2 + spacing}), 0,
              2e-3 * spacing);
  Particles<2> p = at_rest<2>({{0, 0, 0.03}, {0.27, 0, 0.2}});
  WallParticles<2> walls(model.options.obstacles, spacing, 2.1 * spacing);
  walls.append_near(0, 0, 1, p);
  int below = 0, beside = 0;
  for (std::size_t i = 2; i < p.size(); ++i) {
    EXPECT_EQ(p.kind[i], Kind::dummy_wall);
    below += std::abs(p.position[i][1] - wall / 2 + spacing / 2) < 0.01 * spacing;
    beside += std::abs(p.position[i][0] - 0.3 + wall / 2 + spacing / 2) < 0.01 * spacing;
  }
  EXPECT_GT(below, 4);
  EXPECT_GT(beside, 4);
}

/// The rms difference between the front of water, released in a column that is twice as high as
/// wide, and that by the volume of fluid (benchmarks/engines/gerris_dam.gfs), in widths.
double error_of_front(Options o, double width) {
  constexpr std::array<std::pair<double, double>, 7> volume_of_fluid = {
      {{0.5, 1.16}, {1.0, 1.53}, {1.5, 2.03}, {2.0, 2.64}, {2.5, 3.32}, {3.0, 4.07}, {3.5, 4.85}}};
  const double unit = std::sqrt(width / (2 * 9.81));  // s
  const auto water = body_of(o, {width, 0, 2 * width});
  double square = 0;
  for (const auto& [time, front] : volume_of_fluid) {
    flow_until(*water, time * unit);
    double farthest = 0;
    for (const Vec3& x : water->state().positions) farthest = std::max(farthest, x.x());
    square += std::pow((farthest + 0.5 * o.settings.spacing) / width - front, 2);
  }
  return std::sqrt(square / double(volume_of_fluid.size()));
}

// A row of wall particles is rough: collisions with it held back the front, with an error of 0.24.
TEST(MpsWallParticles, DoNotHoldBackTheFrontOfABrokenDam) {
  constexpr double width = 0.05715;
  Options o = tank(2, 8 * width, width / 10);
  o.settings.walls = Walls::particles;
  o.settings.viscosity = 1e-3;
  EXPECT_LT(error_of_front(o, width), 0.15);
}

}  // namespace
}  // namespace snowshed::methods::mps
