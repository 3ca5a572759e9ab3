#include "snowshed/methods/slide/bonds.hpp"

#include <gtest/gtest.h>

#include "methods/slide/slide_testing.hpp"

namespace snowshed::methods::slide {
namespace {

/// Points of a triangular lattice of side 1, `columns` in each of `rows` rows.
Particles lattice(int columns, int rows, double fall = 0) {
  Particles p;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::size_t n = p.size();
      p.resize(n + 1);
      p.x[n] = i + (j % 2) * 0.5;
      p.y[n] = j * std::sqrt(3.0) / 2;
      p.z[n] = -fall * p.x[n];
    }
  return p;
}

TEST(SlideBonds, ALatticeIsBondedAlongItsEdges) {
  const int columns = 7, rows = 5;
  const Bonds bonds = bonds_between(lattice(columns, rows), 0, 1.0, nullptr);
  // Bonds along the rows, and two upward from each point, except at the ends of rows.
  EXPECT_EQ(bonds.size(), std::size_t(rows * (columns - 1) + (rows - 1) * (2 * columns - 1)));
  for (const double length : bonds.rest_length) EXPECT_NEAR(length, 1, 1e-12);
}

TEST(SlideBonds, RestLengthIsTheDistanceInSpace) {
  const Bonds bonds = bonds_between(lattice(3, 2, 1.0), 0, 1.0, nullptr);
  double max_length = 0;
  for (const double length : bonds.rest_length) max_length = std::max(max_length, length);
  EXPECT_NEAR(max_length, std::sqrt(2.0), 1e-12);
}

TEST(SlideBonds, GapsOfTheAreaAreNotBridged) {
  const Particles p = lattice(7, 5);
  Area slotted = rectangle(-1, -1, 8, 8);
  slotted.polygon.holes = {{{2.7, -0.5}, {2.8, -0.5}, {2.8, 7}, {2.7, 7}}};  // a narrow slot
  const std::vector<Area> areas{slotted};
  const Bonds bonds = bonds_between(p, 0, 1.0, &areas);
  EXPECT_LT(bonds.size(), bonds_between(p, 0, 1.0, nullptr).size());
  for (std::size_t b = 0; b < bonds.size(); ++b)
    EXPECT_EQ(p.x[bonds.first[b]] < 2.75, p.x[bonds.second[b]] < 2.75);
}

TEST(SlideBonds, BondsOfRemovedParticlesAreRemoved) {
  Bonds bonds;
  bonds.add(0, 1, 1.0);
  bonds.add(1, 2, 2.0);
  bonds.add(0, 2, 3.0);
  renumber(bonds, {0, removed_particle, 1});
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_EQ(bonds.second[0], 1u);
  EXPECT_EQ(bonds.rest_length[0], 3.0);
}

/// Four particles in two triangles on level ground, without friction or pressure, pulled apart.
struct Strip {
  explicit Strip(double speed, double modulus = 50000, double detrainment = 0) {
    Options o = slide_on(geometry::terrain_of(40, 40, 2, [](double, double) { return 0.0; }),
                         rectangle(10, 10, 60, 60));
    o.gravity = 0;
    o.settings.friction = 0;
    o.settings.friction_law = FrictionLaw::coulomb;
    o.settings.mixing_rate = 0;
    o.settings.time_step = 1e-4;
    o.settings.bond_modulus = modulus;
    o.settings.detrainment = detrainment;
    o.areas.resistance = {rectangle(10, 10, 60, 60)};
    o.settings.resistance = 0;
    slide = make_solver(o);
    const double h = std::sqrt(3.0) / 2;
    ParticleBatch all;
    all.mass = 300;
    all.positions = {{30, 30, 0}, {31, 30, 0}, {30.5, 30 + h, 0}, {31.5, 30 + h, 0}};
    slide->add(all);
    slide->add_velocity({{-speed, 0, 0}, {speed, 0, 0}, {-speed, 0, 0}, {speed, 0, 0}});
  }
  std::unique_ptr<Solver> slide;
};

TEST(SlideBonds, AStripBreaksAtTheFailureStrain) {
  Strip strip(1.0, 1.0);  // bonds too soft to slow it down
  ASSERT_EQ(strip.slide->bonds().size(), 5u);
  // The bonds along the pull lengthen by 2 v t: they are strained by 0.2 after 0.1 s.
  while (strip.slide->bonds().size() == 5u && strip.slide->time() < 0.2) strip.slide->step();
  EXPECT_NEAR(strip.slide->time(), 0.1, 0.002);
}

/// The force along the pull on the lower left particle, divided by that of fresh bonds, in the step
/// to come. It comes from the bond to the lower right one; the bond to the tip above has hardly
/// changed its length.
double relative_pull(Solver& slide) {
  const ParticleState before = slide.state();
  slide.step();
  const ParticleState after = slide.state();
  const particles::FieldView thickness = slide.field("thickness");
  const auto at = [&](std::size_t i) { return *thickness.at<double>(slide.order_by_id()[i]); };
  const Vec3 approach = before.velocities[1] - before.velocities[0];
  const double length = (before.positions[1] - before.positions[0]).norm() + 1e-4 * approach.x();
  const double fresh = (length - 1) * 0.5 * (at(0) + at(1)) * (length / std::sqrt(3.0)) * 50000;
  return after.masses[0] * (after.velocities[0].x() - before.velocities[0].x()) / 1e-4 / fresh;
}

TEST(SlideBonds, AStrainedBondPullsWithModulusTimesAreaTimesStrain) {
  Strip strip(0.1);
  step(*strip.slide, 1);
  EXPECT_NEAR(relative_pull(*strip.slide), 1, 0.02);
}

TEST(SlideBonds, ABondPullsAsTheLighterOfTwoColumnsThatForestThins) {
  Strip strip(0.1, 50000, 3000);
  const auto share = [&] {
    const std::vector<double> m = strip.slide->state().masses;
    return std::min(m[0], m[1]) / 300;
  };
  while (share() > 0.5) strip.slide->step();
  EXPECT_GT(share(), 0.4);
  EXPECT_EQ(strip.slide->bonds().size(), 5u);
  EXPECT_NEAR(relative_pull(*strip.slide) / share(), 1, 0.1);
}

TEST(SlideBonds, ThinnedBondsNeedNoShorterSteps) {
  Particles thinned = lattice(2, 1);
  Bonds bonds;
  bonds.add(0, 1, 1.0);
  const AlignedVector<double> thickness(2, 0.5);
  thinned.mass = {1, 100};
  thinned.fresh_mass = {100, 100};
  Particles heavy = thinned;
  heavy.mass = heavy.fresh_mass;
  EXPECT_NEAR(bond_share(true, thinned.mass.data(), thinned.fresh_mass.data(), 0, 1), 0.01, 1e-15);
  EXPECT_NEAR(max_bond_step(bonds, thinned, thickness, 1e5, true),
              max_bond_step(bonds, heavy, thickness, 1e5, true), 1e-12);
  EXPECT_NEAR(max_bond_step(bonds, thinned, thickness, 1e5, false),
              0.1 * max_bond_step(bonds, heavy, thickness, 1e5, false), 1e-12);
}

/// A slab that lies half on a slope and half on a steeper one; the roll between them pulls it
/// apart.
struct Roll {
  explicit Roll(double modulus, double max_strain) {
    Options o = slide_on(geometry::terrain_of(80, 30, 2,
                                              [](double x, double) {
                                                const double bend = std::max(x - 50, 0.0);
                                                return 200 - 0.5 * x - 0.6 * bend;
                                              }),
                         rectangle(30.3, 18.3, 70.3, 42.3));
    o.settings.friction_law = FrictionLaw::coulomb;
    o.settings.friction = 0.45;
    o.settings.mixing_rate = 0;
    o.settings.bond_modulus = modulus;
    o.settings.max_strain = max_strain;
    slide = released_slide(o);
    while (slide->time() < 1.5) slide->step();
  }
  /// Standard deviation of the speeds, divided by their mean.
  double spread() const {
    double mean = 0, square = 0;
    const ParticleState s = slide->state();
    const double share = 1 / double(s.velocities.size());
    for (const Vec3& u : s.velocities) mean += share * u.norm();
    for (const Vec3& u : s.velocities) square += share * (u.norm() - mean) * (u.norm() - mean);
    return std::sqrt(square) / mean;
  }
  double broken() const { return 1 - double(slide->bonds().size()) / double(slide->bonds_made()); }
  std::unique_ptr<Solver> slide;
};

TEST(SlideBonds, StrongBondsHoldASlabTogetherAndWeakOnesTear) {
  const Roll strong(5e6, 0.5), weak(5e4, 0.05);
  EXPECT_LT(strong.spread(), 0.05);
  EXPECT_GT(weak.spread(), 0.3);
  EXPECT_EQ(strong.broken(), 0);
  EXPECT_GT(weak.broken(), 0.03);
}

}  // namespace
}  // namespace snowshed::methods::slide
