#include "snowshed/methods/grains/solver.hpp"

#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::grains {
namespace {

/// One voxel, or a block, in the middle of a wide box.
LabelImage single_block(std::size_t nx, std::size_t ny, std::size_t nz, std::size_t box = 20) {
  return image_of(box, box, box, [=](std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t low = box / 3;
    const auto in = [low](std::size_t x, std::size_t n) { return x >= low && x < low + n; };
    return in(i, nx) && in(j, ny) && in(k, nz) ? 1 : 0;
  });
}

TEST(GrainsSolver, FreeGrainsKeepEnergyAndVelocity) {
  Options o = grains_of(single_block(5, 2, 3));
  o.energy = true;
  PosedGrains model(o);
  const auto grains = filled_solver(o);
  grains->add_velocity({Vec3(1e-3, 2e-3, -1e-3)});
  const double before = energies_of(*grains).at("kinetic_j");
  take_steps(*grains, 20000);
  EXPECT_NEAR(energies_of(*grains).at("kinetic_j") / before, 1, 1e-12);
  const Vec3 displacement = grains->state().positions[0] - model.state.bodies[0].position;
  EXPECT_TRUE(displacement.isApprox(grains->time() * Vec3(1e-3, 2e-3, -1e-3), 1e-7));
}

TEST(GrainsSolver, FreeFallFollowsNewton) {
  Options o = grains_of(single_block(2, 2, 2));
  o.gravity = 9.81;
  // The scaling multiplies the inertia, so that the weight accelerates the grain 10000 times less.
  o.settings.density_scaling = 1e4;
  const auto grains = filled_solver(o);
  take_steps(*grains, 500);
  EXPECT_NEAR(grains->state().velocities[0].z() / (-9.81e-4 * grains->time()), 1, 1e-10);
  o.settings.density_scaling = 1;
  o.settings.damping = 0.3;
  const auto damped = filled_solver(o);
  take_steps(*damped, 500);  // local damping takes a share of the weight
  EXPECT_NEAR(damped->state().velocities[0].z() / (-0.7 * 9.81 * damped->time()), 1, 2e-3);
}

TEST(GrainsSolver, GrainsFallByDefault) {
  Options o;
  o.sample = make_sample(single_block(2, 2, 2));
  o.settings.damping = 0;
  const auto grains = filled_solver(o);
  take_steps(*grains, 500);
  EXPECT_NEAR(grains->state().velocities[0].z() / (-9.81 * grains->time()), 1, 1e-9);
}

TEST(GrainsSolver, CollisionsKeepMomentumAndEnergy) {
  Options o = grains_of(image_of(24, 24, 24, [](auto i, auto j, auto k) {
    const bool first = i >= 6 && i < 9 && j >= 8 && j < 11 && k >= 8 && k < 12;
    const bool second = i >= 11 && i < 14 && j >= 10 && j < 14 && k >= 9 && k < 11;
    return first ? 1 : second ? 2 : 0;
  }));
  o.settings.friction = 0;
  o.settings.courant_factor = 0.03;
  o.energy = true;
  const auto grains = filled_solver(o);
  grains->add_velocity({Vec3(1, 0, 0), Vec3(-1, 0, 0)});
  const auto momentum = [&] {
    const ParticleState s = grains->state();
    return Vec3(s.masses[0] * s.velocities[0] + s.masses[1] * s.velocities[1]);
  };
  const Vec3 before = momentum();
  const double kinetic = energies_of(*grains).at("kinetic_j");
  bool touched = false;
  while (grains->time() < 8e-5) {
    grains->step();
    touched = touched || grains->measures().contacts > 0;
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(grains->state().velocities[0].x(), 0.5);
  EXPECT_LT((momentum() - before).norm(), 1e-12 * grains->state().masses[0]);
  EXPECT_NEAR(energies_of(*grains).at("kinetic_j") / kinetic, 1, 1e-3);
}

/// Angular momentum about the centre, kg m2/s. The rotation follows from the present spheres and
/// those of the sample, and the inertia from the voxels.
Vec3 spin_momentum_of(const Solver& grains, const Options& o, std::size_t grain) {
  const std::vector<Vec3> now = grains.sphere_positions();
  const Clump& clump = o.sample.clumps[grain];
  const Vec3 center = grains.state().positions[grain];
  Mat3 turned = Mat3::Zero(), before = Mat3::Zero();
  for (std::uint32_t s = clump.first_sphere; s < clump.first_sphere + clump.spheres; ++s) {
    const Vec3 offset = o.sample.spheres[s] - clump.center;
    turned += (now[s] - center) * offset.transpose();
    before += offset * offset.transpose();
  }
  const Mat3 rotation = turned * before.inverse();
  const particles::FieldView spin = grains.field("angular_velocity");
  const double* w = spin.at<double>(grain);
  return o.settings.density *
         (rotation * (clump.inertia * (rotation.transpose() * Vec3(w[0], w[1], w[2]))));
}

TEST(GrainsSolver, SpinningGrainsKeepEnergyAndAngularMomentumOver1e5Steps) {
  Options o = grains_of(image_of(60, 60, 60, [](auto i, auto j, auto k) {
    const bool first = i >= 24 && i < 28 && j >= 28 && j < 31 && k >= 27 && k < 29;
    const bool second = i >= 29 && i < 31 && j >= 30 && j < 35 && k >= 28 && k < 31;
    return first ? 1 : second ? 2 : 0;
  }));
  o.energy = true;
  const auto grains = filled_solver(o);
  grains->add_velocity({Vec3(0.05, 0, 0), Vec3(-0.05, 0, 0)});
  bool touched = false;
  for (int i = 0; i < 100000 && !(touched && grains->measures().contacts == 0); ++i) {
    grains->step();
    touched = touched || grains->measures().contacts > 0;
  }
  ASSERT_TRUE(touched);
  take_steps(*grains, 40000);  // the grains collide again before they separate
  const double kinetic = energies_of(*grains).at("kinetic_j");
  const Vec3 spins[2] = {spin_momentum_of(*grains, o, 0), spin_momentum_of(*grains, o, 1)};
  const std::vector<Vec3> start = grains->sphere_positions();
  double max_error = 0;
  for (int i = 0; i < 100; ++i) {
    take_steps(*grains, 1000);
    max_error = std::max(max_error, std::abs(energies_of(*grains).at("kinetic_j") / kinetic - 1));
    ASSERT_EQ(grains->measures().contacts, 0) << "free flight";
  }
  EXPECT_LT(max_error, 1e-6);
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_GT(spins[g].norm(), 0);
    EXPECT_LT((spin_momentum_of(*grains, o, g) - spins[g]).norm(), 1e-9 * spins[g].norm());
  }
  const std::vector<Vec3> end = grains->sphere_positions();
  EXPECT_GT(((end[0] - end[1]) - (start[0] - start[1])).norm(), test_voxel) << "it has turned";
}

/// A block of voxels. Gravity acts upward and presses it against a flat punch (a cone of 90
/// degrees).
struct Slider {
  Slider(std::size_t nx, std::size_t ny, std::size_t nz, double friction, double speed)
      : v0(speed), mu(friction) {
    Options o = grains_of(image_of(20, 20, 20, [=](auto i, auto j, auto k) {
      return i >= 5 && i < 5 + nx && j >= 10 && j < 10 + ny && k >= 20 - nz ? 1 : 0;
    }));
    o.settings.friction = friction;
    o.gravity = -g;
    o.loading = {{LoadingKind::penetrate, 1e-9, 1e-3, 0}};
    o.cone = {0.01, 90};
    grains = filled_solver(o);
    grains->add_velocity({Vec3(speed, 0, 0)});
  }
  Vec3 velocity() const { return grains->state().velocities[0]; }
  double v0, mu, g = 1e4;
  std::unique_ptr<Solver> grains;
};

/// The impulse of the pressing force is m (g t - v_z).
void expect_coulomb(const Slider& s) {
  const double lost = s.mu * (s.g * s.grains->time() - s.velocity().z());
  EXPECT_NEAR((s.v0 - s.velocity().x()) / lost, 1, 1e-3);
}

TEST(GrainsSolver, SlidingFollowsCoulomb) {
  Slider voxel(1, 1, 1, 0.2, 0.1), block(6, 4, 2, 0.2, 0.1);
  const double until_it_rolls = voxel.v0 / (2.5 * voxel.mu * voxel.g);
  while (voxel.grains->time() < 0.8 * until_it_rolls) voxel.grains->step();
  expect_coulomb(voxel);
  const double until_it_stops = block.v0 / (block.mu * block.g);
  while (block.grains->time() < 0.8 * until_it_stops) block.grains->step();
  expect_coulomb(block);
}

TEST(GrainsSolver, SlidingVoxelsEndUpRollingAtThreeFifthsOfTheirSpeed) {
  // Voxels in a row along y, with I = m (2 r)^2 / 6 about the row: the momentum about the line of
  // contact gives v = v0 / (1 + 2/3).
  for (const std::size_t length : {1, 4}) {
    Slider s(1, length, 1, 0.2, 0.1);
    while (s.grains->time() < 3e-5) s.grains->step();
    double mean = 0;  // the springs of the contact oscillate
    for (int i = 0; i < 2000; ++i) {
      s.grains->step();
      mean += s.velocity().x() / 2000;
    }
    EXPECT_NEAR(mean / s.v0, 0.6, 0.0006) << length;
  }
}

TEST(GrainsSolver, ThreadsDoNotChangeTheBitsInAnyStage) {
  for (const Sides sides : {Sides::walls, Sides::periodic}) {
    Options o = all_stages_options();
    o.settings.sides = sides;
    std::vector<std::unique_ptr<Solver>> all;
    for (const int threads : {1, 2, 3}) {
      o.settings.threads = threads;
      all.push_back(filled_solver(o));
    }
    int stages = 0;
    while (!*all[0]->at_rest()) {
      const int stage = all[0]->stage();
      for (const auto& solver : all)
        for (int i = 0; i < 2000 && solver->stage() == stage; ++i) solver->step();
      ASSERT_GT(all[0]->stage(), stage);
      for (const auto& solver : all) {
        ASSERT_EQ(solver->time(), all[0]->time()) << "stage " << stage;
        ASSERT_EQ(solver->sphere_positions(), all[0]->sphere_positions()) << "stage " << stage;
        ASSERT_EQ(solver->energies(), all[0]->energies()) << "stage " << stage;
      }
      ++stages;
    }
    EXPECT_EQ(stages, 7);
  }
}

TEST(GrainsSolver, ThreadsDoNotChangeTheBits) {
  Options o = grains_of(random_snow(26, 6));
  o.settings.density_scaling = 1e3;
  o.loading = {{LoadingKind::compress, 2, 0.1, 0}};
  o.energy = true;
  const auto single = filled_solver(o);
  take_steps(*single, 300);
  EXPECT_GT(single->measures().contacts, 3 * std::int64_t(pairs_per_thread))
      << "too few for several threads";
  EXPECT_GT(single->measures().broken_in_shear, 0);
  for (const int threads : {2, 3}) {
    o.settings.threads = threads;
    const auto several = filled_solver(o);
    take_steps(*several, 300);
    EXPECT_EQ(single->state().positions, several->state().positions);
    EXPECT_EQ(single->state().velocities, several->state().velocities);
    EXPECT_EQ(single->sphere_positions(), several->sphere_positions());
    EXPECT_EQ(single->energies(), several->energies());
    EXPECT_EQ(single->measures().top_stress, several->measures().top_stress);
  }
}

TEST(GrainsSolver, AcceptsOnlyTheGrainsOfItsSample) {
  const Options o = grains_of(random_snow(12, 5));
  const auto grains = make_solver(o);
  EXPECT_THROW(grains->step(), SimulationError);
  std::vector<ParticleBatch> batches = grains->seed();
  batches[0].masses[0] *= 2;
  EXPECT_THROW(grains->add(batches), InputError);
  batches = grains->seed();
  batches[0].positions.pop_back();
  batches[0].masses.pop_back();
  EXPECT_THROW(grains->add(batches), InputError);
  EXPECT_EQ(grains->size(), 0u);
  grains->add(grains->seed());
  EXPECT_EQ(grains->size(), o.sample.clumps.size());
  EXPECT_THROW(grains->add(grains->seed()), InputError);
  EXPECT_THROW(grains->add_velocity({}), InputError);
}

TEST(GrainsSolver, ReplacedGrainsRestartWithNewIds) {
  Options o = grains_of(random_snow(12, 5));
  o.settings.density_scaling = 1e3;
  o.loading = {{LoadingKind::compress, 2, 0.1, 0}};
  const auto grains = filled_solver(o);
  const std::uint32_t count = std::uint32_t(grains->size());
  const ParticleState fresh = grains->state();
  take_steps(*grains, 100);
  const double time = grains->time();
  grains->replace(grains->seed());
  EXPECT_EQ(grains->state().positions, fresh.positions);
  EXPECT_EQ(grains->state().ids[0], count);
  EXPECT_EQ(grains->time(), time);
  EXPECT_EQ(grains->measures().axial_strain, 0);
}

TEST(GrainsSolver, FieldsHaveOneValuePerGrain) {
  const auto grains = filled_solver(grains_of(random_snow(12, 5)));
  for (const particles::FieldInfo& info : grains->fields())
    EXPECT_EQ(grains->field(info.name).count, grains->size()) << info.name;
  const particles::FieldView radius = grains->field("equivalent_radius"),
                             mass = grains->field("mass");
  const double r = *radius.at<double>(0);
  EXPECT_NEAR(917 * 4.18879020478639 * r * r * r / *mass.at<double>(0), 1, 1e-12);
  EXPECT_THROW(grains->field("thickness"), InputError);
}

TEST(GrainsSolver, StaysFiniteWithExtremeSettings) {
  const LabelImage snow = random_snow(12, 4);
  const LabelImage voxel = single_block(1, 1, 1, 4);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const LabelImage* image : {&snow, &voxel})
    for (const double modulus : {1e3, 1e9, 1e12})
      for (const double friction : {0.0, 5.0})
        for (const double strength : {0.0, infinite})
          for (const double scaling : {1.0, 1e6}) {
            Options o = grains_of(*image);
            o.settings.elastic_modulus = modulus;
            o.settings.friction = friction;
            o.settings.tensile_strength = o.settings.shear_strength = strength;
            o.settings.density_scaling = scaling;
            o.settings.damping = 0.2;
            o.energy = true;
            o.loading = {{LoadingKind::compress, 10, 0.5, 0}};
            const auto grains = filled_solver(o);
            take_steps(*grains, 150);
            SCOPED_TRACE("E " + std::to_string(modulus) + ", friction " + std::to_string(friction) +
                         ", strength " + std::to_string(strength) + ", scaling " +
                         std::to_string(scaling));
            for (const auto& [name, joules] : grains->energies())
              ASSERT_TRUE(std::isfinite(joules)) << name;
            for (const Vec3& x : grains->sphere_positions()) ASSERT_TRUE(x.allFinite());
            ASSERT_GT(grains->time_step(), 0);
          }
}

}  // namespace
}  // namespace snowshed::methods::grains
