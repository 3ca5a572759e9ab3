#include "snowshed/methods/mps/solver.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "mps_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mps/kernel_function.hpp"
#include "snowshed/methods/mps/rheology.hpp"

namespace snowshed {
namespace {

// Of the regular lattice, by hand and by others.
TEST(MpsKernel, ConstantsOfALattice) {
  const struct {
    int dimension;
    double radius, n0, lambda;
  } known[] = {{2, 2.1, 6.539697, 1.388351},  {3, 2.1, 14.418575, 1.701738},
               {2, 3.1, 18.976417, 2.448472}, {3, 3.1, 54.321209, 3.243422},
               {2, 4.0, 35.609223, 3.707100}, {3, 4.0, 123.991565, 5.211991}};
  for (const auto& k : known) {
    const KernelConstants found = kernel_constants(k.dimension, k.radius);
    EXPECT_NEAR(found.number_density, k.n0, 5e-7);
    EXPECT_NEAR(found.lambda, k.lambda, 5e-7);
  }
}

TEST(MpsRheology, IsContinuousWhereItBecomesDilatant) {
  MpsSettings s;
  s.cohesion = 100;
  const Rheology law = Rheology::from(s);
  const double yield = law.yield_stress(50), rate = s.dilatant_rate;
  EXPECT_NEAR(yield, 100 + 50 * std::tan(24 * 3.14159265358979 / 180), 1e-9);
  EXPECT_NEAR(law.apparent_viscosity(yield, rate * (1 - 1e-9)),
              law.apparent_viscosity(yield, rate * (1 + 1e-9)), 1e-6);
  EXPECT_NEAR(law.apparent_viscosity(yield, 4 * rate) * 4,
              law.apparent_viscosity(yield, rate) * std::pow(4, s.dilatant_exponent), 1e-6);
  EXPECT_NEAR(law.apparent_viscosity(yield, 1e-12), s.viscosity + s.stress_growth * yield, 1e-6);
}

/// The slope of the pressure over height, between two spacings from the bottom and the top, over
/// the specific weight.
double pressure_slope(const Method& method, const MpsOptions& o, double height) {
  const ParticleState s = method.state();
  const double margin = 2 * o.settings.spacing;
  double n = 0, z = 0, p = 0, zz = 0, zp = 0;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    const double h = s.positions[i].z();
    if (h < margin || h > height - margin) continue;
    ++n;
    z += h;
    p += s.pressures[i];
    zz += h * h;
    zp += h * s.pressures[i];
  }
  return -(n * zp - z * p) / (n * zz - z * z) / (o.settings.density * 9.81);
}

TEST(MpsSolver, FirstStepOfAColumnIsHydrostatic) {
  const int dimension = 2;
  {
    const double width = dimension == 2 ? 0.2 : 0.1;
    MpsOptions o = tank(dimension, width, 0.01);
    o.settings.pressure_tolerance = 1e-6;
    o.settings.viscosity = 1e-6;
    const auto mps = make_mps(o);
    mps->add(block_of(o, Vec3::Zero(), {width, width, 0.2}));
    mps->step();
    EXPECT_NEAR(pressure_slope(*mps, o, 0.2), 1, 0.005);
    EXPECT_LT(mps->motion(0).rms_speed, 0.05 * 9.81 * mps->time_step());
  }
}

TEST(MpsSolver, AllPreconditionersFindTheSamePressure) {
  std::vector<double> pressures[3];
  for (const int k : {0, 1, 2}) {
    MpsOptions o = tank(2, 0.2, 0.01);
    o.settings.pressure_tolerance = 1e-9;
    o.settings.preconditioner = MpsPreconditioner(k);
    const auto mps = make_mps(o);
    mps->add(block_of(o, Vec3::Zero(), {0.1, 0, 0.2}));
    mps->step();
    pressures[k] = mps->state().pressures;
    EXPECT_LE(mps->report().pressure_residual, 1e-9);
  }
  for (std::size_t i = 0; i < pressures[0].size(); ++i) {
    EXPECT_NEAR(pressures[0][i], pressures[2][i], 0.02);
    EXPECT_NEAR(pressures[1][i], pressures[2][i], 0.02);
  }
}

TEST(MpsSolver, NothingFallsThroughWalls) {
  MpsOptions o = tank(2, 0.4, 0.01);
  o.settings.viscosity = 1e-3;
  const auto mps = make_mps(o);
  mps->add(block_of(o, Vec3::Zero(), {0.1, 0, 0.2}));
  while (mps->time() < 0.4) mps->step();
  for (const Vec3& x : mps->state().positions) {
    EXPECT_GT(x.x(), 0);
    EXPECT_LT(x.x(), 0.4);
    EXPECT_GT(x.z(), 0);
  }
}

TEST(MpsSolver, AnUnsolvedEquationLeavesTheStateAsItWas) {
  MpsOptions o = tank(2, 0.2, 0.01);
  o.settings.max_iterations = 1;
  o.settings.pressure_tolerance = 1e-9;
  const auto mps = make_mps(o);
  mps->add(block_of(o, Vec3::Zero(), {0.2, 0, 0.2}));
  EXPECT_THROW(mps->step(), SimulationError);
  EXPECT_EQ(mps->time(), 0);
  EXPECT_EQ(mps->motion(0).rms_speed, 0);
}

using MpsCheckpoint = TemporaryFolder;

TEST_F(MpsCheckpoint, SameBitsOnAnyThreadsAndAfterResuming) {
  const auto run = [this](int threads, bool resume) {
    MpsOptions o = tank(2, 1.0, 0.01);
    o.settings.threads = threads;
    o.settings.rheology = MpsRheology::bingham_dilatant;
    auto mps = make_mps(o);
    mps->add(block_of(o, Vec3::Zero(), {0.5, 0, 0.5}));
    for (int k = 0; k < 6; ++k) {
      if (resume && k == 3) {
        BinaryWriter out;
        mps->save(out);
        out.save(path("state"));
        mps = make_mps(o);
        mps->load(BinaryReader::load(path("state")));
      }
      mps->step();
    }
    return mps->state().positions;
  };
  const std::vector<Vec3> once = run(1, false);
  EXPECT_EQ(once, run(3, false));
  EXPECT_EQ(once, run(1, true));
}

// Saito's snow without cohesion: Coulomb's friction of the weight, g (sin a - cos a tan phi).
TEST(MpsSolver, SlabOnAnInclineAcceleratesByCoulombsFriction) {
  for (const double degrees : {35.0, 45.0}) {
    const double slope = degrees * 3.14159265358979 / 180;
    MpsOptions o = channel(0.5, 0.5, 50, 0);
    o.obstacles.pop_back();
    o.settings.spacing = 0.01;
    o.period = 1;
    o.settings.density = 200;
    o.settings.viscosity = 1e-5;
    o.settings.friction_angle = 24;
    o.gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
    const auto mps = make_mps(o);
    mps->add(block_of(o, Vec3::Zero(), {1, 0, 0.1}));
    while (mps->time() < 0.5) mps->step();
    double speed = 0;
    for (const Vec3& u : mps->state().velocities) speed += u.x() / double(mps->size());
    const double friction = std::tan(24 * 3.14159265358979 / 180);
    const double expected = 9.81 * (std::sin(slope) - std::cos(slope) * friction) * mps->time();
    EXPECT_NEAR(speed, expected, 0.02 * expected) << degrees;
  }
}

// Plug and discharge of a Bingham fluid between plates. Sheared rows of particles feel up to a
// tenth less viscosity than a lattice does (docs/mps.md); the aim is 2 %.
TEST(MpsSolver, BinghamPoiseuilleFlow) {
  const double half_gap = 0.1, force = 100, yield = 5;
  MpsOptions o = channel(0.2, half_gap, 40, force);
  o.settings.cohesion = yield;
  o.settings.density = 100;
  o.gravity = {force / o.settings.density, 0, 0};
  const auto mps = make_mps(o);
  mps->add(block_of(o, Vec3::Zero(), {0.2, 0, 2 * half_gap}));
  while (mps->time() < 3) mps->step();
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
  EXPECT_NEAR(speed / count, expected, 0.1 * expected);
  EXPECT_NEAR(flow * 2 * half_gap / double(s.positions.size()), discharge, 0.1 * discharge);
}

}  // namespace
}  // namespace snowshed
