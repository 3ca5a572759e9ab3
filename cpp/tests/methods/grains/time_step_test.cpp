#include "snowshed/methods/grains/time_step.hpp"

#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"

namespace snowshed::methods::grains {
namespace {

TEST(GrainsTimeStep, FollowsFromTheRotationOfAVoxelOnABlock) {
  Options o = grains_of(image_of(12, 12, 12, [](auto i, auto j, auto k) {
    const auto middle = [](auto x) { return x >= 4 && x < 7; };
    if (i == 5 && j == 5 && k == 7) return 2;
    return middle(i) && middle(j) && middle(k) ? 1 : 0;
  }));
  const double r = 0.5 * test_voxel, k = o.settings.elastic_modulus * r;
  const double mass = o.settings.density * 8 * r * r * r;
  // The cube with I = 2/3 m r^2 has one contact, at the distance r from its centre.
  EXPECT_NEAR(filled_solver(o)->time_step() / (0.3 * std::sqrt(mass / (1.5 * k))), 1, 1e-9);
  o.settings.density_scaling = 100;
  EXPECT_NEAR(filled_solver(o)->time_step() / (3 * std::sqrt(mass / (1.5 * k))), 1, 1e-9);
}

TEST(GrainsTimeStep, IsStableWithTheLargestFactor) {
  Options o = grains_of(random_snow(15, 5, 0.0));
  o.settings.courant_factor = 1;
  o.settings.tensile_strength = o.settings.shear_strength = 1e12;
  o.energy = true;
  const auto grains = filled_solver(o);
  std::vector<Vec3> kicks;
  Random random(5);
  for (std::size_t i = 0; i < grains->size(); ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    kicks.push_back(1e-3 * Vec3(x - 0.5, y - 0.5, z - 0.5));
  }
  grains->add_velocity(kicks);
  const double kinetic = energies_of(*grains).at("kinetic_j");
  take_steps(*grains, 8000);
  EXPECT_LT(energies_of(*grains).at("kinetic_j"), 1.5 * kinetic);
  EXPECT_GT(energies_of(*grains).at("kinetic_j"), 0);
}

}  // namespace
}  // namespace snowshed::methods::grains
