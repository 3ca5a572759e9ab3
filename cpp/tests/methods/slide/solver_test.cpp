#include "snowshed/methods/slide/solver.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::slide {
namespace {

constexpr double gravity = 9.81;

Options slab(double degrees, double friction, FrictionLaw law = FrictionLaw::coulomb) {
  Options o = slide_on(inclined(degrees, 120, 40), rectangle(20.3, 18.3, 60.3, 58.3));
  o.settings.friction_law = law;
  o.settings.friction = friction;
  return o;
}

TEST(SlideSolver, ABlockWithCoulombFrictionFollowsNewton) {
  for (const double friction : {0.0, 0.2, 0.5}) {
    const auto slide = released_slide(slab(35, friction));
    step(*slide, 200);
    const double acceleration =
        gravity * (std::sin(radians(35)) - friction * std::cos(radians(35)));
    EXPECT_NEAR(mean_slide_velocity(*slide).norm() / (acceleration * 2.0), 1, 0.005) << friction;
  }
}

TEST(SlideSolver, ABlockWithVoellmyFrictionFollowsItsEquationOfMotion) {
  Options fine = slab(35, 0.325, FrictionLaw::voellmy);
  fine.areas.release = {rectangle(20.3, 18.3, 48.3, 46.3)};
  fine.settings.layer_thickness = 0.02;  // many particles, so that the thickness is even
  fine.settings.bonds = false;           // with bonds the thin rim would hold the middle back
  fine.settings.mixing_rate = 0;         // so would mixing
  const auto slide = released_slide(fine);
  step(*slide, 150);
  // du/dt = a - b u^2, u = sqrt(a / b) tanh(sqrt(a b) t), in the middle, where h stays 0.5 m.
  const double a = gravity * (std::sin(radians(35)) - 0.325 * std::cos(radians(35)));
  const double b = gravity / (58 * 0.5);
  const double expected = std::sqrt(a / b) * std::tanh(std::sqrt(a * b) * 1.5);
  const ParticleState s = slide->state();
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : s.positions) middle += x / double(s.positions.size());
  double speed = 0, count = 0;
  for (std::size_t i = 0; i < s.positions.size(); ++i)
    if ((s.positions[i] - middle).norm() < 5) {
      speed += s.velocities[i].norm();
      ++count;
    }
  EXPECT_NEAR(speed / count / expected, 1, 0.005);
}

TEST(SlideSolver, PeakSpeedMatchesTheSnowAndFadesBeyondItsRim) {
  Options o = slide_on(inclined(35), rectangle(20.3, 18.3, 50.3, 42.3, 1.0));
  o.settings.bonds = false;
  o.settings.layer_thickness = 0.1;
  o.settings.friction = 0;
  o.settings.mixing_rate = 0;
  const auto slide = make_solver(o);
  std::vector<ParticleBatch> snow = slide->seed();
  const double speed = 100;  // m/s; pressure hardly changes it within a step
  snow[0].velocity = speed * Vec3(std::cos(radians(35)), 0, -std::sin(radians(35)));
  slide->add(snow);
  // All snow has the same velocity, so that the peak speed at a node depends only on the mass
  // around it.
  const std::vector<double>& peaks = slide->peaks().speed;
  const auto at = [&](int column) { return peaks[slide->terrain().index(column, 15)] / speed; };
  EXPECT_NEAR(at(17), 1, 1e-3);
  for (int column = 24; column < 29; ++column) EXPECT_GE(at(column), at(column + 1)) << column;
  EXPECT_GT(at(25), 0.9);  // the snow ends at 50.3 m, just beyond column 25
  EXPECT_GT(at(27), at(28));
  EXPECT_GT(at(28), 0);
  EXPECT_EQ(at(29), 0);
}

TEST(SlideSolver, SnowBelowTheAngleOfFrictionDoesNotMove) {
  Options o = slab(20, 0.6);
  o.settings.mixing_rate = 0;
  const auto slide = released_slide(o);
  const ParticleState before = slide->state();
  step(*slide, 50);
  const ParticleState after = slide->state();
  std::size_t still = 0;
  for (std::size_t i = 0; i < before.positions.size(); ++i)
    still += before.positions[i] == after.positions[i] && after.velocities[i].isZero(0.0);
  // The rim slumps under its own pressure; the rest is held.
  EXPECT_GT(double(still) / double(before.positions.size()), 0.7);
}

TEST(SlideSolver, PressureDoesNotMoveTheCenterOfMass) {
  Options o = slide_on(geometry::terrain_of(60, 60, 2, [](double, double) { return 0.0; }),
                       rectangle(40.3, 42.3, 70.3, 72.3));
  o.settings.friction = 0;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.bonds = false;
  o.settings.mixing_rate = 0;
  const auto slide = released_slide(o);
  step(*slide, 100);
  EXPECT_GT(slide->motion(0).rms_speed, 0.2);  // the snow spreads
  EXPECT_LT(mean_slide_velocity(*slide).norm(), 1e-9 * slide->motion(0).rms_speed);
}

TEST(SlideSolver, MassIsConservedAndLeavingMassIsCounted) {
  Options o = slide_on(inclined(40, 40, 30), rectangle(20.3, 18.3, 50.3, 40.3));
  const auto slide = released_slide(o);
  const double released_mass = total_mass(*slide);
  while (!*slide->at_rest() && slide->time() < 60) slide->step();
  const MassBalance& m = slide->mass_balance();
  EXPECT_GT(m.particles_left, 0);
  EXPECT_NEAR((total_mass(*slide) + m.left_terrain) / released_mass, 1, 1e-12);
  EXPECT_NEAR(m.released / released_mass, 1, 1e-12);
}

TEST(SlideSolver, EntrainedMassEqualsTheGainOfTheParticles) {
  Options o = slide_on(inclined(38, 100, 30), rectangle(20.3, 18.3, 50.3, 40.3));
  o.areas.entrainment = {rectangle(60, 6, 120, 52, 0.3)};
  const auto slide = released_slide(o);
  const double released_mass = total_mass(*slide);
  step(*slide, 1500);
  const MassBalance& m = slide->mass_balance();
  EXPECT_GT(m.entrained, 0.01 * released_mass);
  EXPECT_NEAR((total_mass(*slide) + m.left_terrain - m.entrained) / released_mass, 1, 1e-12);
}

TEST(SlideSolver, ForestSlowsSnowDown) {
  Options open = slide_on(inclined(38, 100, 30), rectangle(20.3, 18.3, 50.3, 40.3));
  Options forest = open;
  forest.settings.resistance = 0.5;
  forest.areas.resistance = {rectangle(60, 6, 120, 52)};
  const auto a = released_slide(open), b = released_slide(forest);
  step(*a, 1000);
  step(*b, 1000);
  EXPECT_LT(mean_slide_velocity(*b).norm(), 0.9 * mean_slide_velocity(*a).norm());
}

bool are_equal(const Method& a, const Method& b) {
  const ParticleState s = a.state(), t = b.state();
  return s.positions == t.positions && s.velocities == t.velocities && s.masses == t.masses &&
         s.ids == t.ids;
}

TEST(SlideSolver, ThreadsDoNotChangeTheBits) {
  Options o = slide_on(inclined(38, 100, 60), rectangle(20.3, 18.3, 80.3, 98.3));
  o.settings.layer_thickness = 0.1;
  const auto single = released_slide(o);
  o.settings.threads = 3;
  const auto three = released_slide(o);
  step(*single, 60);
  step(*three, 60);
  EXPECT_TRUE(are_equal(*single, *three));
}

class SlideCheckpoint : public io::TemporaryFolder {};

TEST_F(SlideCheckpoint, ResumesToTheSameBits) {
  const Options o = slide_on(inclined(38, 100, 40), rectangle(20.3, 18.3, 50.3, 58.3));
  const auto slide = released_slide(o);
  step(*slide, 45);  // between two sorts
  const auto resumed = resumed_slide(o, *slide, path("c.bin"));
  step(*slide, 60);
  step(*resumed, 60);
  EXPECT_TRUE(are_equal(*slide, *resumed));
  EXPECT_EQ(slide->peaks().speed, resumed->peaks().speed);
  EXPECT_EQ(slide->bonds().rest_length, resumed->bonds().rest_length);
}

TEST(SlideSolver, ExtremeTerrainGivesFinitePositions) {
  const auto cliff = [](double x, double) { return x < 60 ? 300.0 : 200.0; };
  const auto pit = [](double x, double y) {
    return std::hypot(x - 60, y - 40) < 8 ? 0.0 : 100 - 0.7 * x;
  };
  const auto gully = [](double x, double y) {
    return 200 - 0.7 * x - (std::abs(y - 40) < 1 ? 6 : 0);
  };
  const auto flat = [](double, double) { return 10.0; };
  for (const auto& f :
       {geometry::terrain_of(90, 40, 2, cliff), geometry::terrain_of(90, 40, 2, pit),
        geometry::terrain_of(90, 40, 2, gully), geometry::terrain_of(90, 40, 2, flat)})
    for (const double thickness : {0.001, 0.5, 10.0}) {
      const auto slide = released_slide(slide_on(f, rectangle(30.3, 24.3, 50.3, 52.3, thickness)));
      for (int i = 0; i < 120 && slide->size() > 0; ++i) slide->step();
      for (const Vec3& x : slide->state().positions) ASSERT_TRUE(x.allFinite());
    }
}

TEST(SlideSolver, AreasBeyondTheTerrainAreRefused) {
  EXPECT_THROW(make_solver(slide_on(inclined(35), rectangle(20, 20, 500, 40))), InputError);
}

TEST(SlideSolver, TerrainHolesWithinReleaseAreasAreRefused) {
  for (const int node : {10, 15, 20}) {  // at a corner of the area, within, and at another corner
    geometry::HeightField holed = inclined(35);
    holed.heights[holed.index(node, node)] = std::nan("");
    EXPECT_THROW(make_solver(slide_on(holed, rectangle(20.3, 20.3, 39.7, 39.7))), InputError);
    EXPECT_NO_THROW(make_solver(slide_on(holed, rectangle(60, 20, 80, 40))));
  }
}

}  // namespace
}  // namespace snowshed::methods::slide
