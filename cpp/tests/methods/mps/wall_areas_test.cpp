// Contacts divide the surface of a wall among them.
#include "snowshed/methods/mps/wall_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "mps_testing.hpp"
#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

constexpr double tank_width = 0.2, tank_spacing = 0.02;

/// The areas on each wall of a tank that is full up to `tank_width`, over those of the wet
/// surfaces. The rows stand `row` spacings apart.
template <int D>
std::vector<double> covered_shares(Walls walls, double row) {
  Options o = tank(D, tank_width, tank_spacing);
  o.settings.walls = walls;
  const int rows = int(std::lround(tank_width / (row * tank_spacing)));
  Particles<D> p;
  for (const Vec3& x :
       block_of(o, Vec3::Zero(), {tank_width, tank_width, rows * tank_spacing}).positions) {
    const std::size_t i = p.size();
    p.resize(i + 1);
    p.position[i] = section<D>(Vec3(x.x(), x.y(), row * x.z()));
    p.velocity[i] = p.pressure_acceleration[i] = p.viscous_acceleration[i] = VecD<D>::Zero();
    p.kind[i] = Kind::moving;
    p.event[i] = 0;
    p.mass[i] = Model<D>(o).particle_mass();
  }
  const Model<D> model(o);
  Workspace<D> work;
  if (walls == Walls::particles) {
    work.walls = WallParticles<D>(model.options.obstacles, tank_spacing, model.reach());
    work.walls.append_near(0, o.period, model.particle_mass(), p);
  }
  find_neighbours(model, p, 0.0, work);
  const std::vector<double> areas = contact_areas(model, p, work.near);
  std::vector<double> shares(o.obstacles.size());
  for (std::size_t k = 0; k < areas.size(); ++k)
    shares[work.near.contacts.all()[k].obstacle] += areas[k] / std::pow(tank_width, D - 1);
  return shares;
}

TEST(MpsWallAreas, AreTheCellsOfALattice) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    for (const double share : covered_shares<2>(walls, 1)) EXPECT_NEAR(share, 1, 1e-3);
    for (const double share : covered_shares<3>(walls, 1)) EXPECT_NEAR(share, 1, 1e-3);
  }
}

// Eleven rows in place of ten had 10 % too large an area.
TEST(MpsWallAreas, CoverTheSurfaceOnceIfRowsCrowd) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    EXPECT_NEAR(covered_shares<2>(walls, 10.0 / 11)[1], 1, 0.02) << int(walls);
    EXPECT_NEAR(covered_shares<3>(walls, 10.0 / 11)[1], 1, 0.02) << int(walls);
  }
}

}  // namespace
}  // namespace snowshed::methods::mps
