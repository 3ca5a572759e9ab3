#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::slide {
namespace {

constexpr double thickness = 0.5;  // m

/// A slab on level ground without friction, so that it keeps its speed, in forest.
Options gliding(Mode mode, double detrainment) {
  Options o = slide_on(geometry::terrain_of(80, 50, 2, [](double, double) { return 0.0; }),
                       rectangle(20.3, 20.3, 60.3, 80.3, thickness));
  o.settings.mode = mode;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.friction = 0;
  o.settings.bonds = false;
  o.settings.mixing_rate = 0;
  o.settings.artificial_viscosity = 0;
  o.settings.layer_thickness = 0.05;
  o.settings.resistance = 0;
  o.settings.detrainment = detrainment;
  o.areas.resistance = {rectangle(2, 2, 150, 96)};
  return o;
}

std::unique_ptr<Solver> gliding_at(const Options& options, double speed) {
  auto slide = released_slide(options);
  slide->add_velocity(std::vector<Vec3>(slide->size(), Vec3(speed, 0, 0)));
  return slide;
}

TEST(SlideDetrainment, ABlockOfConstantSpeedLosesMassLinearly) {
  // dm/dt = -K A / u, with A = m / (rho h) constant, because h falls with m.
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    const double speed = 5, coefficient = 60, time = 1;
    const auto slide = gliding_at(gliding(mode, coefficient), speed);
    const ParticleState before = slide->state();
    step(*slide, 100);
    const ParticleState after = slide->state();
    ASSERT_EQ(before.ids, after.ids);
    double lost = 0, area = 0;
    for (std::size_t i = 0; i < after.ids.size(); ++i) {
      const Vec3& x = before.positions[i];
      if (x.x() < 30 || x.x() > 50 || x.y() < 30 || x.y() > 70) continue;  // away from the rim
      lost += before.masses[i] - after.masses[i];
      area += before.masses[i] / (300 * thickness);
    }
    // The lattice of particles fits into the outline within 2 %.
    EXPECT_NEAR(lost / (coefficient * area / speed * time), 1, 0.02) << int(mode);
  }
}

TEST(SlideDetrainment, TheLostMassIsCounted) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    const auto slide = gliding_at(gliding(mode, 100), 3);
    const double before = total_mass(*slide);
    step(*slide, 100);
    const MassBalance& m = slide->mass_balance();
    EXPECT_GT(m.detrained, 0.05 * before);
    EXPECT_NEAR((total_mass(*slide) + m.detrained + m.left_terrain) / before, 1, 1e-12);
  }
}

TEST(SlideDetrainment, SnowAtRestLosesNoMass) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    const auto slide = released_slide(gliding(mode, 100));
    slide->step();
    EXPECT_EQ(slide->mass_balance().detrained, 0);
  }
}

TEST(SlideDetrainment, ForestMayTakeAllSnow) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options o = gliding(mode, 1e5);
    o.energy = true;
    const auto slide = gliding_at(o, 3);
    const double before = total_mass(*slide);
    for (int i = 0; i < 3 && slide->size() > 0; ++i) slide->step();
    EXPECT_EQ(slide->size(), 0u);
    EXPECT_TRUE(*slide->at_rest());
    EXPECT_NEAR(slide->mass_balance().detrained / before, 1, 1e-12);
    EXPECT_EQ(slide->mass_balance().left_terrain, 0);
  }
}

TEST(SlideDetrainment, FastAndThickSnowIsResistedAndTheFastestDestroysTheForest) {
  struct Case {
    double speed, min_thickness, max_speed;
    bool detrains, resists;
  };
  for (const Mode mode : {Mode::improved, Mode::compatible})
    for (const Case& c : {Case{5, 0.1, 40, true, false}, Case{9, 0.6, 40, true, false},
                          Case{9, 0.1, 40, false, true}, Case{9, 0.1, 8, false, false}}) {
      Options o = gliding(mode, 50);
      o.settings.resistance = 0.05;
      o.settings.forest_min_thickness = c.min_thickness;
      o.settings.forest_max_speed = c.max_speed;
      const auto slide = gliding_at(o, c.speed);
      // The particles in the middle, which no rim with thinner snow has reached.
      const ParticleState before = slide->state();
      step(*slide, 10);
      const ParticleState after = slide->state();
      for (std::size_t i = 0; i < after.ids.size(); ++i) {
        const Vec3& x = before.positions[i];
        if (x.x() < 38 || x.x() > 42 || x.y() < 48 || x.y() > 52) continue;
        EXPECT_EQ(after.masses[i] < before.masses[i], c.detrains) << c.speed;
        EXPECT_EQ(after.velocities[i].norm() < 0.99 * c.speed, c.resists) << c.speed;
      }
    }
}

TEST(SlideDetrainment, EnergyBalanceCloses) {
  Options o = slide_on(inclined(36, 100, 40), rectangle(20.3, 20.3, 50.3, 60.3));
  o.energy = true;
  o.settings.detrainment = 20;
  o.areas.resistance = {rectangle(40, 2, 120, 76)};
  const auto slide = released_slide(o);
  const auto energy = [&](const std::string& name) {
    for (const auto& [key, joules] : capability<KeepsEnergy>(*slide)->energies())
      if (key == name) return joules;
    return std::nan("");
  };
  const double before = energy("potential_j");
  step(*slide, 400);
  EXPECT_GT(energy("detrainment_j"), 0);
  EXPECT_LT(std::abs(energy("residual_j")),
            0.02 * (before - energy("potential_j") - energy("detrainment_j")));
}

/// Returns a slab that slides half into a forest and half beside it.
Options beside_forest(double detrainment) {
  Options o = slide_on(inclined(36, 60, 40), rectangle(20.3, 20.3, 50.3, 60.3));
  o.settings.detrainment = detrainment;
  o.settings.bond_modulus = 1e6;  // decides on the length of the steps
  o.areas.resistance = {rectangle(40, 2, 100, 40)};
  return o;
}

TEST(SlideDetrainment, BondsThrowNoLightParticleAway) {
  const auto slide = released_slide(beside_forest(100));
  double fastest = 0;
  for (int i = 0; i < 600; ++i) {
    slide->step();
    for (const Vec3& u : slide->state().velocities) fastest = std::max(fastest, u.norm());
  }
  EXPECT_GT(slide->mass_balance().detrained, 0.2 * slide->mass_balance().released);
  EXPECT_LT(fastest, 4);  // a slab without forest reaches 3.0 m/s
  EXPECT_EQ(slide->mass_balance().left_terrain, 0);
}

TEST(SlideDetrainment, ALightParticleAmongThickSnowVanishesAfterAFiniteTime) {
  // It loses the share K dt / (u rho h) of its mass in each step, because the faster snow around it
  // keeps its thickness.
  const double coefficient = 100, speed = 0.05, mass = 1e-3;
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    const auto slide = gliding_at(gliding(mode, coefficient), 20);
    const auto light = std::uint32_t(slide->size());  // its id
    ParticleBatch batch;
    batch.positions = {Vec3(55, 50, 0)};
    batch.velocity = Vec3(speed, 0, 0);
    batch.mass = mass;
    slide->add({batch});
    int steps = 0;
    const auto is_there = [&] {
      const ParticleState s = slide->state();
      return std::find(s.ids.begin(), s.ids.end(), light) != s.ids.end();
    };
    while (steps < 400 && is_there()) {
      slide->step();
      ++steps;
    }
    const double share = coefficient * 0.01 / (speed * 300 * thickness);
    if (mode == Mode::improved) EXPECT_NEAR(steps / (std::log(0.01) / std::log1p(-share)), 1, 0.1);
    EXPECT_LT(steps, 300);  // the compatible mode leaves 1e-12 of a fresh particle
    EXPECT_EQ(slide->mass_balance().left_terrain, 0);
  }
}

class SlideDetrainmentCheckpoint : public io::TemporaryFolder {};

TEST_F(SlideDetrainmentCheckpoint, ResumesWithTheForestThatStandsOnAnyNumberOfThreads) {
  Options o = slide_on(inclined(38, 100, 40), rectangle(20.3, 20.3, 50.3, 60.3));
  o.settings.detrainment = 20;
  o.settings.resistance = 0.1;
  o.settings.forest_max_speed = 6;
  o.settings.forest_min_speed = 4;
  o.settings.forest_min_thickness = 0.2;
  o.areas.resistance = {rectangle(40, 2, 120, 76)};
  const auto slide = released_slide(o);
  step(*slide, 150);
  o.settings.threads = 3;
  const auto resumed = resumed_slide(o, *slide, path("c.bin"));
  step(*slide, 150);
  step(*resumed, 150);
  EXPECT_GT(slide->mass_balance().detrained, 0);
  EXPECT_EQ(slide->state().positions, resumed->state().positions);
  EXPECT_EQ(slide->state().masses, resumed->state().masses);
  EXPECT_EQ(slide->mass_balance().detrained, resumed->mass_balance().detrained);
}

}  // namespace
}  // namespace snowshed::methods::slide
