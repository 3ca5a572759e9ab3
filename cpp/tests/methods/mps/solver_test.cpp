#include "snowshed/methods/mps/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/temporary_folder.hpp"
#include "mps_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mps/kernel_function.hpp"
#include "snowshed/methods/mps/rheology.hpp"

namespace snowshed::methods::mps {
namespace {

// Constants of the regular lattice, against values computed by hand and by others.
TEST(MpsKernelFunction, ConstantsOfALatticeMatchKnownValues) {
  const struct {
    int dimension;
    double radius, n0, lambda;
  } known[] = {{2, 2.1, 6.539697, 1.388351},  {3, 2.1, 14.418575, 1.701738},
               {2, 3.1, 18.976417, 2.448472}, {3, 3.1, 54.321209, 3.243422},
               {2, 4.0, 35.609223, 3.707100}, {3, 4.0, 123.991565, 5.211991}};
  for (const auto& k : known) {
    const KernelConstants constants = kernel_constants(k.dimension, k.radius);
    EXPECT_NEAR(constants.number_density, k.n0, 5e-7);
    EXPECT_NEAR(constants.lambda, k.lambda, 5e-7);
  }
}

// The sum of w is smaller in a hexagonal lattice than in a square one of the same density.
TEST(MpsKernelFunction, FillingMeasuresTheSpaceOfAnyArrangement) {
  const KernelConstants k = kernel_constants(2, 2.1);
  const double side = std::sqrt(2 / std::sqrt(3.0));
  double number = 0, filling = 1;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const double w = kernel_weight(side * std::sqrt(double(i * i + i * j + j * j)), k.radius);
      if ((i == 0 && j == 0) || w == 0) continue;
      number += w;
      filling += filling_weight(w);
    }
  EXPECT_NEAR(filling / k.filling, 1, 1e-3);
  EXPECT_LT(number / k.number_density, 0.994);
}

TEST(MpsRheology, IsContinuousAtTheDilatantRate) {
  Settings s;
  s.cohesion = 100;
  const Rheology law = Rheology::from(s);
  const double yield = law.yield_stress(50), rate = s.dilatant_rate;
  EXPECT_NEAR(yield, 100 + 50 * std::tan(24 * 3.14159265358979 / 180), 1e-9);
  EXPECT_NEAR(law.apparent_viscosity(yield, rate * (1 - 1e-9)),
              law.apparent_viscosity(yield, rate * (1 + 1e-9)), 1e-6);
  EXPECT_NEAR(law.apparent_viscosity(yield, 4 * rate) * 4,
              law.apparent_viscosity(yield, rate) * std::pow(4, s.dilatant_exponent), 1e-6);
  EXPECT_NEAR(law.apparent_viscosity(yield, 1e-18), s.viscosity + s.stress_growth * yield, 1e-6);
}

/// The slope of the pressure over height, relative to the specific weight. Particles within two
/// spacings from the bottom or the top are left out.
double pressure_slope(const Method& method, const Options& o, double height) {
  const ParticleState s = method.state();
  const double margin = 2 * o.settings.spacing;
  const std::vector<double> pressures = values_by_id(method, "pressure");
  double n = 0, z = 0, p = 0, zz = 0, zp = 0;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    const double h = s.positions[i].z();
    if (h < margin || h > height - margin) continue;
    ++n;
    z += h;
    p += pressures[i];
    zz += h * h;
    zp += h * pressures[i];
  }
  return -(n * zp - z * p) / (n * zz - z * z) / (o.settings.density * 9.81);
}

TEST(MpsSolver, FirstStepOfAColumnIsHydrostatic) {
  Options o = tank(2, 0.2, 0.01);
  o.settings.pressure_tolerance = 1e-6;
  o.settings.viscosity = 1e-6;
  const auto mps = body_of(o, {0.2, 0, 0.2});
  mps->step();
  EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.005);
  EXPECT_LT(mps->motion(0).rms_speed, 0.05 * 9.81 * mps->time_step());
}

// Water; a lattice of particles is unstable without shifting, or with conservative gradients.
TEST(MpsSolver, ColumnsOfWaterStayAtRest) {
  for (const int dimension : {2, 3}) {
    const double width = dimension == 2 ? 0.2 : 0.1, spacing = dimension == 2 ? 0.01 : 0.02;
    Options o = tank(dimension, width, spacing);
    o.settings.viscosity = 1e-3;
    const auto mps = body_of(o, {width, width, 0.2});
    flow_until(*mps, 1);
    EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01) << dimension;
    EXPECT_LT(mps->motion(0).rms_speed, 0.02 * std::sqrt(9.81 * 0.2)) << dimension;
    EXPECT_LT(mps->report().density_error, 0.02) << dimension;
  }
}

/// z of the highest particle, m.
double highest(const Method& method) {
  double z = -HUGE_VAL;
  for (const Vec3& x : method.state().positions) z = std::max(z, x.z());
  return z;
}

TEST(MpsSolver, ABodyFallsByDefault) {
  Options o;
  o.dimension = 2;
  const auto mps = body_of(o, {4 * o.settings.spacing, 0, 4 * o.settings.spacing});
  flow_until(*mps, 0.02);
  for (const Vec3& u : mps->state().velocities) EXPECT_NEAR(u.z() / mps->time(), -9.81, 0.1);
}

// Gaps that particles at the surface leave behind would make the water rise, and then boil.
TEST(MpsSolver, AColumnOfWaterDoesNotRise) {
  Options o = tank(2, 0.2, 0.01);
  o.settings.viscosity = 1e-3;
  const auto mps = body_of(o, {0.2, 0, 0.2});
  flow_until(*mps, 10);
  EXPECT_NEAR(highest(*mps), 0.195, 0.01 * 0.2);
  EXPECT_LT(mps->motion(0).rms_speed, 0.006);
  EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01);
}

// Inner walls beside disorder would be taken for a surface, and the pressure would fall by 12 % for
// a step.
TEST(MpsSolver, TheFloorOfWallParticlesBearsTheWaterInEveryStep) {
  Options o = tank(2, 0.2, 0.01);
  o.settings.walls = Walls::particles;
  o.settings.viscosity = 1e-3;
  const auto mps = body_of(o, {0.2, 0, 0.2});
  while (mps->time() < 10) {
    mps->step();
    ASSERT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01) << mps->time();
  }
  EXPECT_LT(mps->motion(0).rms_speed, 0.02);
}

// Pressure and viscosity are not coupled at rest, so errors of the pressure do not grow.
TEST(MpsSolver, AStiffColumnIsHydrostatic) {
  for (const Walls walls : {Walls::mirrors, Walls::particles}) {
    Options o = tank(2, 0.2, 0.01);
    o.settings.walls = walls;
    o.settings.viscosity = 1e4;
    const auto mps = body_of(o, {0.2, 0, 0.2});
    for (int k = 0; k < 20; ++k) {
      mps->step();
      EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01) << int(walls);
    }
  }
}

// The same between wall particles, which conduct pressure also in corners.
TEST(MpsSolver, ColumnsBetweenWallParticlesStayAtRest) {
  for (const int dimension : {2, 3}) {
    Options o = tank(dimension, 0.1, dimension == 2 ? 0.01 : 0.02);
    o.settings.walls = Walls::particles;
    o.settings.viscosity = 1e-3;
    const auto mps = body_of(o, {0.1, 0.1, 0.2});
    mps->step();
    EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01) << dimension;
    flow_until(*mps, 0.3);
    EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.03) << dimension;
    EXPECT_LT(mps->motion(0).rms_speed, 0.05 * std::sqrt(9.81 * 0.2)) << dimension;
    EXPECT_EQ(mps->size(), std::size_t(dimension == 2 ? 200 : 250));
  }
}

// Viscosity that acted before the pressure would hang stiff snow on sticky walls.
TEST(MpsSolver, StiffSnowPressesOnTheFloor) {
  Options o = tank(3, 0.1, 0.02);
  o.settings.rheology = ShearLaw::bingham;
  o.settings.cohesion = 100;
  const auto mps = body_of(o, {0.1, 0.1, 0.2});
  flow_until(*mps, 0.1);
  EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.01);
  EXPECT_LT(mps->motion(0).rms_speed, 1e-6);
}

TEST(MpsSolver, AllPreconditionersFindTheSamePressure) {
  std::vector<double> pressures[3];
  for (const int k : {0, 1, 2}) {
    Options o = tank(2, 0.2, 0.01);
    o.settings.pressure_tolerance = 1e-9;
    o.settings.preconditioner = Preconditioner(k);
    const auto mps = body_of(o, {0.1, 0, 0.2});
    mps->step();
    pressures[k] = values_by_id(*mps, "pressure");
    EXPECT_LE(mps->report().pressure_residual, 1e-9);
  }
  for (std::size_t i = 0; i < pressures[0].size(); ++i) {
    EXPECT_NEAR(pressures[0][i], pressures[2][i], 0.02);
    EXPECT_NEAR(pressures[1][i], pressures[2][i], 0.02);
  }
}

TEST(MpsSolver, NothingFallsThroughWalls) {
  Options o = tank(2, 0.4, 0.01);
  o.settings.viscosity = 1e-3;
  const auto mps = body_of(o, {0.1, 0, 0.2});
  while (mps->time() < 0.4) mps->step();
  for (const Vec3& x : mps->state().positions) {
    EXPECT_GT(x.x(), 0);
    EXPECT_LT(x.x(), 0.4);
    EXPECT_GT(x.z(), 0);
  }
}

TEST(MpsSolver, AnUnsolvedEquationLeavesTheStateUnchanged) {
  Options o = tank(2, 0.2, 0.01);
  o.settings.max_iterations = 1;
  o.settings.pressure_tolerance = 1e-9;
  const auto mps = body_of(o, {0.2, 0, 0.2});
  EXPECT_THROW(mps->step(), SimulationError);
  EXPECT_EQ(mps->time(), 0);
  EXPECT_EQ(mps->motion(0).rms_speed, 0);
}

using MpsReproducibility = io::TemporaryFolder;

TEST_F(MpsReproducibility, ThreadsAndResumingDoNotChangeTheBits) {
  const auto run = [this](int threads, bool resume, Walls walls, Coupling coupling) {
    Options o = tank(2, 1.0, 0.02);
    o.settings.walls = walls;
    o.settings.coupling = coupling;
    o.settings.threads = threads;
    o.settings.rheology = ShearLaw::bingham_dilatant;
    o.settings.yield_iterations = 2;  // enough to compare bits
    auto mps = body_of(o, {1.0, 0, 1.0});
    for (int k = 0; k < 6; ++k) {
      if (resume && k == 3) {
        io::BinaryWriter out;
        mps->save(out);
        out.save(path("state"));
        mps = make_solver(o);
        mps->load(io::BinaryReader::load(path("state")));
      }
      mps->step();
    }
    return mps->state().positions;
  };
  const auto expect_the_same = [&](Walls walls, Coupling coupling) {
    const std::vector<Vec3> reference = run(1, false, walls, coupling);
    EXPECT_EQ(reference, run(3, false, walls, coupling));
    EXPECT_EQ(reference, run(1, true, walls, coupling));
  };
  expect_the_same(Walls::mirrors, Coupling::stiff);
  expect_the_same(Walls::mirrors, Coupling::always);
  expect_the_same(Walls::particles, Coupling::stiff);
}

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

double mean_speed(const Method& method) {
  double speed = 0;
  for (const Vec3& u : method.state().velocities) speed += u.x() / double(method.size());
  return speed;
}

TEST(MpsSolver, ASlabOnAnInclineFollowsCoulomb) {
  for (const Walls walls : {Walls::mirrors, Walls::particles})
    for (const double degrees : {35.0, 45.0}) {
      Options o = incline(degrees, 0, 0.01);
      o.settings.walls = walls;
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

// No force causes a pressure: the right-hand side of its equation consists of rounding errors.
TEST(MpsSolver, FlowsBetweenWallParticlesWithoutASurface) {
  Options o = channel(0.2, 0.1, 10, 100);
  o.settings.walls = Walls::particles;
  o.settings.cohesion = 5;
  const auto mps = body_of(o, {0.2, 0, 0.2});
  EXPECT_NO_THROW(flow_until(*mps, 0.1));
  EXPECT_GT(mean_speed(*mps), 0);
}

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

// A thin Bingham fluid comes to rest with h(x) = sqrt(2 tau0 (xf - x)/(rho g)), Liu and Mei (1989).
TEST(MpsSolver, BinghamSlumpComesToRest) {
  Options o = tank(2, 10, 0.02);
  o.settings.rheology = ShearLaw::bingham;
  o.settings.cohesion = 100;
  o.settings.friction_angle = 0;
  o.settings.viscosity = 5;
  const auto mps = body_of(o, {0.3, 0, 0.2});
  flow_until(*mps, 2);
  const double scale = 2 * 100 / (1000 * 9.81), area = 0.3 * 0.2;
  const double front = std::pow(1.5 * area / std::sqrt(scale), 2.0 / 3);
  const double width = 0.08, in_column = 0.02 * 0.02 / width;  // four particles wide
  std::vector<double> height(200);
  for (const Vec3& x : mps->state().positions) height.at(std::size_t(x.x() / width)) += in_column;
  double error = 0, square = 0;
  for (std::size_t k = 0; k < height.size(); ++k) {
    const double expected = std::sqrt(scale * std::max(0.0, front - (double(k) + 0.5) * width));
    error += (height[k] - expected) * (height[k] - expected);
    square += expected * expected;
  }
  EXPECT_LT(std::sqrt(error / square), 0.1);
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

// A column of water, twice as high as wide, collapses. Contacts of particles take little of its
// energy.
TEST(MpsSolver, DamBreakKeepsItsEnergy) {
  const double width = 0.05715;
  Options o = tank(2, 6 * width, width / 20);  // the loss is proportional to the spacing
  o.settings.viscosity = 1e-3;
  const auto mps = body_of(o, {width, 0, 2 * width});
  const auto energy = [&] {
    const ParticleState s = mps->state();
    double sum = 0;
    for (std::size_t i = 0; i < s.positions.size(); ++i)
      sum += 0.5 * s.velocities[i].squaredNorm() + 9.81 * s.positions[i].z();
    return sum;
  };
  const double before = energy();
  flow_until(*mps, 3 * std::sqrt(width / (2 * 9.81)));
  EXPECT_NEAR(energy(), before, 0.04 * before);
}

}  // namespace
}  // namespace snowshed::methods::mps
