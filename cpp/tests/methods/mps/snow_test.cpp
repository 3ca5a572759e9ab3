// Snow with a yield stress: slabs, cuts and slumps that flow or stand, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "mps_testing.hpp"

namespace snowshed::methods::mps {
namespace {

/// A slab on an endless incline, with Saito's snow.
Options incline(double degrees, double cohesion, double spacing) {
  const double slope = degrees * 3.14159265358979 / 180;
  Options o = channel(15 * spacing, 0.5, 10, 0);
  o.obstacles.pop_back();
  o.settings.spacing = spacing;
  o.settings.density = 200;
  o.settings.viscosity = 0.012;
  o.settings.friction_angle = 24;
  o.settings.cohesion = cohesion;
  o.gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
  return o;
}

/// g (sin a - cos a tan phi), Coulomb's friction of the weight.
double frictional_acceleration(const Options& o) {
  return o.gravity.x() + o.gravity.z() * std::tan(24 * 3.14159265358979 / 180);
}

TEST(MpsSolver, ASlabOnAnInclineFollowsCoulomb) {
  for (const Walls walls : {Walls::mirrors, Walls::particles})
    for (const double degrees : {35.0, 45.0}) {
      Options o = incline(degrees, 0, 0.01);
      o.settings.walls = walls;
      // With 0.012 Pa s a viscous layer would make the slab 3 % slower than Coulomb's friction.
      o.settings.viscosity = 1e-6;
      const auto mps = body_of(o, {o.period, 0, 0.1});
      flow_until(*mps, 0.3);
      const double expected = frictional_acceleration(o) * mps->time();
      EXPECT_NEAR(mean_speed(*mps), expected, 0.02 * expected) << degrees << ' ' << int(walls);
    }
}

/// A slab of 12 particles on an incline of 35 degrees, and its acceleration by Coulomb's friction
/// and its cohesion; the snow has hardly any viscosity. `thickness` is relative to the slab that
/// cohesion just holds, c/(rho g (sin a - cos a tan phi)).
struct CohesiveSlab {
  std::unique_ptr<Solver> mps;
  double acceleration;
};
CohesiveSlab cohesive_slab(double thickness, Walls walls) {
  const double held = 100 / (200 * frictional_acceleration(incline(35, 100, 1)));
  Options o = incline(35, 100, thickness * held / 12);
  o.settings.walls = walls;
  o.settings.viscosity = 1e-6;
  CohesiveSlab slab{make_solver(o), (1 - 1 / thickness) * frictional_acceleration(o)};
  ParticleBatch snow = block_of(o, Vec3::Zero(), {o.period, 0, thickness * held});
  if (slab.acceleration < 0) snow.velocity = {0.05, 0, 0};
  slab.mps->add({snow});
  return slab;
}

// A slab stops if it is thinner than the one that its cohesion holds; otherwise it accelerates.
class MpsSlab : public testing::TestWithParam<Walls> {};
TEST_P(MpsSlab, StopsIfThinAndSlidesIfThick) {
  const CohesiveSlab thin = cohesive_slab(0.95, GetParam());
  flow_until(*thin.mps, 0.5);
  EXPECT_LT(std::abs(mean_speed(*thin.mps)), 1e-4);
  for (const double thickness : {1.05, 1.2}) {
    const CohesiveSlab slab = cohesive_slab(thickness, GetParam());
    flow_until(*slab.mps, 0.5);
    const double expected = slab.acceleration * slab.mps->time();
    EXPECT_NEAR(mean_speed(*slab.mps), expected, 0.05 * expected) << thickness;
  }
}

INSTANTIATE_TEST_SUITE_P(Walls, MpsSlab, testing::Values(Walls::mirrors, Walls::particles));

/// Relative errors of the plug's speed and of the discharge of a Bingham fluid between plates.
struct FlowErrors {
  double plug, discharge;
};
FlowErrors bingham_poiseuille(int across, double length) {
  const double half_gap = 0.1, force = 100, yield = 5;
  Options o = channel(length, half_gap, across, force);
  o.settings.cohesion = yield;
  o.settings.density = 100;
  o.gravity = {force / o.settings.density, 0, 0};
  const auto mps = body_of(o, {length, 0, 2 * half_gap});
  flow_until(*mps, 1.5);
  const double plug = yield / force;
  const double expected = force * (half_gap - plug) * (half_gap - plug) / 2;
  const double ratio = plug / half_gap;
  const double discharge =
      2 * force * std::pow(half_gap, 3) / 3 * (1 - 1.5 * ratio + 0.5 * std::pow(ratio, 3));
  double flow = 0, speed = 0, count = 0;
  const ParticleState s = mps->state();
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    flow += s.velocities[i].x();
    if (std::abs(s.positions[i].z() - half_gap) > 0.5 * plug) continue;
    speed += s.velocities[i].x();
    ++count;
  }
  return {speed / count / expected - 1,
          flow * 2 * half_gap / double(s.positions.size()) / discharge - 1};
}

TEST(MpsSolver, BinghamPoiseuilleFlowConverges) {
  const FlowErrors coarse = bingham_poiseuille(10, 0.2), fine = bingham_poiseuille(20, 0.1);
  EXPECT_LT(std::abs(fine.plug), 0.03);
  EXPECT_LT(std::abs(fine.discharge), 0.03);
  EXPECT_GT(std::log2(std::abs(coarse.plug / fine.plug)), 1.5);  // order of convergence
}

/// The height of a heap beside x = 0 in columns of this width, m. A particle covers the cell around
/// it, because it represents one; counts of centres jump where a row of them crosses a column's
/// end.
std::vector<double> column_heights(const Method& method, double spacing, double width) {
  std::vector<double> heights(std::size_t(2 / width));
  for (const Vec3& x : method.state().positions) {
    const double begin = std::max(0.0, x.x() - 0.5 * spacing), end = begin + spacing;
    for (std::size_t k = std::size_t(begin / width); double(k) * width < end; ++k) {
      const double from = std::max(begin, double(k) * width);
      const double to = std::min(end, double(k + 1) * width);
      heights.at(k) += (to - from) * spacing / width;
    }
  }
  return heights;
}

// A thin Bingham fluid comes to rest with h(x) = sqrt(2 tau0 (xf - x)/(rho g)), Liu and Mei (1989).
TEST(MpsSolver, BinghamSlumpComesToRest) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    Options o = tank(2, 10, 0.02);
    o.settings.walls = walls;
    o.settings.rheology = ShearLaw::bingham;
    o.settings.cohesion = 100;
    o.settings.friction_angle = 0;
    o.settings.viscosity = 5;
    const auto mps = body_of(o, {0.3, 0, 0.2});
    flow_until(*mps, 2);
    const double scale = 2 * 100 / (1000 * 9.81), area = 0.3 * 0.2;
    const double front = std::pow(1.5 * area / std::sqrt(scale), 2.0 / 3);
    const double width = 2 * o.settings.spacing;
    const std::vector<double> heights = column_heights(*mps, o.settings.spacing, width);
    double error = 0, square = 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
      const double expected = std::sqrt(scale * std::max(0.0, front - (double(k) + 0.5) * width));
      error += (heights[k] - expected) * (heights[k] - expected);
      square += expected * expected;
    }
    EXPECT_LT(std::sqrt(error / square), 0.1) << int(walls);
  }
}

/// The advance of the face of a vertical cut in snow without friction in 1 s, over the height.
/// `strength` is c/(rho g H).
double advance_of_cut(double strength, Walls walls) {
  Options o = tank(2, 10, 0.05);
  o.settings.walls = walls;
  o.settings.density = 200;
  o.settings.rheology = ShearLaw::bingham;
  o.settings.friction_angle = 0;
  o.settings.cohesion = strength * 200 * 9.81;
  const auto mps = body_of(o, {2, 0, 1});
  flow_until(*mps, 1);
  double front = 0;
  for (const Vec3& x : mps->state().positions) front = std::max(front, x.x() + 0.025);
  return front - 2;
}

// Limit analysis: it stands if c/(rho g H) is more than 0.26.
TEST(MpsSolver, AVerticalCutStandsOrFalls) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    EXPECT_LT(advance_of_cut(0.28, walls), 0.02) << int(walls);
    EXPECT_GT(advance_of_cut(0.25, walls), 0.05) << int(walls);
  }
}

/// A square of snow without gravity that spins at 2 rad/s.
std::unique_ptr<Solver> spinning_square(int dimension) {
  Options o = tank(dimension, 10, 0.05);
  o.obstacles.clear();
  o.gravity.setZero();
  o.settings.rheology = ShearLaw::bingham;
  o.settings.cohesion = 1e4;
  o.settings.friction_angle = 0;
  auto mps = make_solver(o);
  const double depth = dimension == 3 ? 0.3 : 0;
  ParticleBatch snow = block_of(o, {-0.25, -depth / 2, -0.25}, {0.25, depth / 2, 0.25});
  mps->add({snow});
  std::vector<Vec3> spin;
  for (const Vec3& x : mps->state().positions) spin.push_back(2 * Vec3::UnitY().cross(x));
  mps->add_velocity(spin);
  return mps;
}

double angular_momentum(const Method& method) {
  double sum = 0;
  const ParticleState s = method.state();
  for (std::size_t i = 0; i < s.positions.size(); ++i)
    sum += s.positions[i].cross(s.velocities[i]).y();
  return sum;
}

// Rotation costs nothing, although the snow has the stress of its centrifugal forces.
TEST(MpsSolver, StiffSnowKeepsItsSpin) {
  for (const int dimension : {2, 3}) {
    const auto mps = spinning_square(dimension);
    const double before = angular_momentum(*mps);
    flow_until(*mps, 1.5);  // half a turn
    EXPECT_NEAR(angular_momentum(*mps), before, 0.02 * std::abs(before)) << dimension;
  }
}

// The stress of an elastic strain has no moment, also where neighbours are on one side only.
TEST(MpsSolver, ShearedSnowKeepsItsAngularMomentum) {
  Options o = tank(2, 10, 0.05);
  o.obstacles.clear();
  o.gravity.setZero();
  o.settings.rheology = ShearLaw::bingham;
  o.settings.cohesion = 1000;
  o.settings.friction_angle = 0;
  o.settings.yield_strain = 0.1;
  const auto mps = make_solver(o);
  mps->add({block_of(o, {-0.4, 0, -0.1}, {0.4, 0, 0.1})});
  std::vector<Vec3> shear;
  for (const Vec3& x : mps->state().positions) shear.push_back(0.5 * Vec3(x.z(), 0, x.x()));
  mps->add_velocity(shear);
  const double before = angular_momentum(*mps);
  flow_until(*mps, 1);
  EXPECT_NEAR(angular_momentum(*mps), before, 0.01 * std::abs(before));
}

// Its strain holds snow behind a free face; with a viscous stress it creeps by 0.4 mm.
TEST(MpsSolver, StandingSnowDoesNotCreep) {
  Options o = tank(2, 10, 0.1);
  o.settings.density = 200;
  o.settings.rheology = ShearLaw::bingham;
  o.settings.friction_angle = 0;
  o.settings.cohesion = 0.5 * 200 * 9.81;
  const auto mps = body_of(o, {2, 0, 1});
  flow_until(*mps, 0.5);
  const ParticleState before = mps->state();
  flow_until(*mps, 2);
  const ParticleState after = mps->state();
  double farthest = 0;
  for (std::size_t i = 0; i < before.positions.size(); ++i)
    farthest = std::max(farthest, (after.positions[i] - before.positions[i]).norm());
  EXPECT_LT(farthest, 2e-4);
}

}  // namespace
}  // namespace snowshed::methods::mps
