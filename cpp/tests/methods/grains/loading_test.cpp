#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods::grains {
namespace {

/// A bar, n x n voxels wide, that fills the box and consists of two grains bonded in the middle.
Options bar(std::size_t n, std::size_t height) {
  Options o =
      grains_of(image_of(n, n, height, [=](auto, auto, auto k) { return k < height / 2 ? 1 : 2; }));
  o.settings.bonded_plates = true;
  o.settings.damping = 0.5;
  o.energy = true;
  return o;
}

TEST(Loading, ABarBreaksInTensionAtItsStrength) {
  Options o = bar(4, 6);
  o.loading = {{LoadingKind::stretch, 0.005, 0.01, 0}};
  const auto grains = filled_solver(o);
  double peak = 0;
  while (!*grains->at_rest()) {
    grains->step();
    peak = std::max(peak, -grains->measures().top_stress);
  }
  EXPECT_NEAR(peak / o.settings.tensile_strength, 1, 0.01);
  EXPECT_GE(grains->measures().broken_in_tension, 16);
  EXPECT_NEAR(grains->measures().top_stress, 0, 0.05 * peak);
}

TEST(Loading, ALayerBreaksInShearAtItsStrength) {
  Options o = bar(6, 2);
  o.settings.tensile_strength = 1e9;
  o.settings.friction = 0;
  o.loading = {{LoadingKind::shear, 0.005, 0.03, 0}};
  o.settings.sides = Sides::walls;
  const auto grains = filled_solver(o);
  double peak = 0;
  while (!*grains->at_rest()) {
    grains->step();
    peak = std::max(peak, grains->measures().shear_stress);
  }
  EXPECT_NEAR(peak / o.settings.shear_strength, 1, 0.02);
  EXPECT_GT(grains->measures().broken_in_shear, 0);
  EXPECT_EQ(grains->measures().broken_in_tension, 0);
}

TEST(Loading, SnowRecoversIfNoBondBreaks) {
  Options o = grains_of(random_snow(18, 5));
  o.settings.damping = 0.2;
  o.energy = true;
  o.loading = {{LoadingKind::compress, 0.02, 3e-4, 0},
               {LoadingKind::hold, 0.02, 3e-4, 0},
               {LoadingKind::unload, 0.02, 1, 0}};
  const auto grains = filled_solver(o);
  double half = 0, full = 0;
  while (grains->measures().stage == 0) {
    grains->step();
    const LoadingMeasures m = grains->measures();
    if (m.axial_strain < 1.5e-4) half = m.top_stress;
    if (m.stage == 0) full = m.top_stress;
  }
  EXPECT_NEAR(full / half, 2, 0.1) << "linear";
  load_all(*grains, 200000);
  const LoadingMeasures end = grains->measures();
  EXPECT_EQ(end.broken_in_tension + end.broken_in_shear, 0);
  EXPECT_LE(end.top_stress, 0);
  EXPECT_LT(end.axial_strain, 0.1 * 3e-4);
  EXPECT_EQ(end.stage, 3);
  const auto e = energies_of(*grains);
  EXPECT_LT(e.at("friction_j") + e.at("damping_j"), 1e-7);
}

TEST(Loading, SnowBreaksInCompressionAndItsEnergyCloses) {
  Options o = grains_of(random_snow(18, 5));
  o.settings.density_scaling = 100;
  o.settings.damping = 0.2;
  o.energy = true;
  o.loading = {{LoadingKind::compress, 1, 0.2, 0}};
  const auto grains = filled_solver(o);
  const std::int64_t bonds = grains->measures().bonds;
  load_all(*grains, 100000);
  const LoadingMeasures end = grains->measures();
  EXPECT_NEAR(end.axial_strain, 0.2, 1e-3);
  EXPECT_GT(end.broken_in_tension + end.broken_in_shear, bonds / 10);
  EXPECT_EQ(end.bonds + end.broken_in_tension + end.broken_in_shear, bonds);
  EXPECT_NEAR(end.solid_fraction / filled_solver(o)->measures().solid_fraction, 1 / 0.8, 2e-3);
  const auto e = energies_of(*grains);
  EXPECT_GT(e.at("boundary_work_j"), 0);
  for (const char* part : {"friction_j", "damping_j", "broken_bonds_j", "elastic_normal_j"})
    EXPECT_GT(e.at(part), 0) << part;
  EXPECT_LT(std::abs(e.at("residual_j")) / e.at("boundary_work_j"), 0.01);
}

TEST(Loading, AStressEndsAStage) {
  Options o = grains_of(random_snow(15, 5));
  o.settings.damping = 0.2;
  o.loading = {{LoadingKind::compress, 0.05, 0.2, 5e4}, {LoadingKind::unload, 0.05, 0.2, 2e4}};
  const auto grains = filled_solver(o);
  while (grains->measures().stage == 0) grains->step();
  EXPECT_NEAR(grains->measures().top_stress, 5e4, 1e4);
  load_all(*grains, 100000);
  EXPECT_NEAR(grains->measures().top_stress, 2e4, 1e4);
}

TEST(Loading, ShearKeepsTheRequestedNormalStress) {
  Options o = grains_of(random_snow(15, 5, 0.0));
  o.settings.sides = Sides::periodic;
  o.settings.damping = 0.4;
  o.settings.bonded_plates = true;
  o.settings.tensile_strength = o.settings.shear_strength = 1e8;  // so that it shears as a solid
  o.energy = true;
  o.loading = {{LoadingKind::shear, 0.02, 6e-4, 1e5}};
  const auto grains = filled_solver(o);
  double mean = 0, count = 0;
  while (!*grains->at_rest()) {
    grains->step();
    if (grains->measures().strain < 3e-4) continue;
    mean += grains->measures().top_stress;
    ++count;
  }
  EXPECT_NEAR(mean / count / 1e5, 1, 0.02);
  EXPECT_NEAR(grains->measures().shear_strain, 6e-4, 1e-5);
  EXPECT_GT(grains->measures().shear_stress, 1e5);
  const auto e = energies_of(*grains);
  EXPECT_LT(std::abs(e.at("residual_j")) / std::abs(e.at("boundary_work_j")), 0.01);
}

TEST(Loading, ShrinkingPeriodicSidesPressLikeWalls) {
  for (const Sides sides : {Sides::walls, Sides::periodic}) {
    // A full block of grains: an elastic solid.
    Options o = grains_of(image_of(
        8, 8, 8, [](auto i, auto j, auto k) { return 1 + i / 4 + 2 * (j / 4) + 4 * (k / 4); }));
    o.settings.sides = sides;
    o.settings.damping = 0.3;
    o.energy = true;
    o.loading = {{LoadingKind::isotropic, 0.01, 2e-4, 0}};
    const auto grains = filled_solver(o);
    load_all(*grains, 100000);
    const LoadingMeasures m = grains->measures();
    EXPECT_GT(m.top_stress, 0);
    // The number of springs in a row is the same in all directions, except at the ends: walls and
    // plates add a spring at both ends, a period adds only one.
    const double springs = sides == Sides::walls ? 3 : 2;
    const double side_stress = o.settings.elastic_modulus * 0.5 * test_voxel *
                               (8 * test_voxel * 2e-4 / springs) / (test_voxel * test_voxel);
    EXPECT_NEAR(m.side_stress / side_stress, 1, 0.05);
    EXPECT_NEAR(m.top_stress * 3 / (side_stress * springs), 1, 0.05);
    const auto e = energies_of(*grains);
    EXPECT_LT(std::abs(e.at("residual_j")) / e.at("boundary_work_j"), 0.01);
  }
}

TEST(Loading, AConeMeetsResistance) {
  Options o = grains_of(random_snow(18, 5, 0.0));
  o.settings.density_scaling = 100;
  o.settings.damping = 0.2;
  o.energy = true;
  o.cone = {2e-4, 30};
  o.loading = {{LoadingKind::compress, 1, 0.01, 0}, {LoadingKind::penetrate, 1, 0.3, 0}};
  const auto grains = filled_solver(o);
  while (grains->measures().stage == 0) grains->step();
  double peak = 0;
  while (!*grains->at_rest()) {
    grains->step();
    peak = std::max(peak, grains->measures().cone_force);
  }
  EXPECT_GT(peak, 0);
  EXPECT_EQ(grains->measures().top_stress, 0);
  const auto e = energies_of(*grains);
  EXPECT_LT(std::abs(e.at("residual_j")) / e.at("boundary_work_j"), 0.01);
}

TEST(Loading, ImpossibleStagesAreRefused) {
  Options o = grains_of(random_snow(12, 5));
  const auto refused = [&](std::vector<LoadingStage> stages) {
    o.loading = std::move(stages);
    EXPECT_THROW(make_solver(o), InputError);
  };
  refused({{LoadingKind::compress, 0, 0.1, 0}});
  refused({{LoadingKind::compress, 1, 1.0, 0}});
  refused({{LoadingKind::shear, 1, 0.1, -1}});
  refused({{LoadingKind::stretch, 1, 0.1, 0}});
  refused({{LoadingKind::penetrate, 1, 0.1, 0}, {LoadingKind::compress, 1, 0.1, 0}});
}

}  // namespace
}  // namespace snowshed::methods::grains
