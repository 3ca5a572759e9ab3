// The record of the forces on walls: weights, water on a wall, and Coulomb's law.
#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mps/mps_testing.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/advance.hpp"

namespace snowshed::methods::mps {
namespace {

constexpr double g = 9.81;

Options named_tank(int dimension, double width, double spacing) {
  Options o = tank(dimension, width, spacing);
  const char* names[] = {"floor", "left", "right", "front", "back"};
  for (std::size_t i = 0; i < o.obstacles.size(); ++i) o.obstacles[i].name = names[i];
  o.forces = true;
  return o;
}

/// Mean forces on all obstacles from now on until `time`, N.
std::vector<ContactImpulse> mean_forces(Solver& solver, double time) {
  const double begin = solver.time();
  const auto before = solver.sample_forces(1);
  advance_to(solver, time);
  const auto after = solver.sample_forces(1);
  std::vector<ContactImpulse> forces;
  for (std::size_t i = 0; i < after.size(); ++i)
    forces.push_back(1 / (solver.time() - begin) * (after[i].impulse - before[i].impulse));
  return forces;
}

TEST(WallForces, WaterInATankPressesOnFloorAndSides) {
  for (const int dimension : {2, 3})
    for (const Walls walls : {Walls::mirrors, Walls::particles}) {
      const double spacing = dimension == 2 ? 0.01 : 0.02, width = 0.2, depth = 0.2;
      Options o = named_tank(dimension, width, spacing);
      o.settings.walls = walls;
      o.settings.viscosity = 0.5;
      const auto solver = make_solver(o);
      const double across = dimension == 3 ? width : 1;
      const ParticleBatch water = block_of(o, Vec3::Zero(), Vec3(width, width, depth));
      solver->add(water);
      advance_to(*solver, 0.5);
      const auto forces = mean_forces(*solver, 0.8);
      // The floor carries the weight, apart from the drag of the sides on water that still moves.
      double lifted = 0;
      for (const ContactImpulse& force : forces) lifted -= force.total().z();
      EXPECT_NEAR(lifted / (water.total_mass() * g), 1, 1e-4) << dimension << int(walls);
      EXPECT_NEAR(forces[0].total().z() / (-water.total_mass() * g), 1, 2e-4);
      const double side = 0.5 * 1000 * g * depth * depth * across;
      EXPECT_NEAR(forces[1].total().x() / -side, 1, 0.01) << dimension << int(walls);
      EXPECT_NEAR(forces[2].total().x() / side, 1, 0.01) << dimension << int(walls);
      EXPECT_NEAR(forces[2].center().z() / (depth / 3), 1, 0.05);
      EXPECT_LT(solver->forces()->unbalanced().norm(),
                1e-3 * water.total_mass() * g * solver->time());
    }
}

TEST(WallForces, RestingForcesAreMeansOverTheLastMoments) {
  Options o = named_tank(2, 0.2, 0.02);
  const auto solver = make_solver(o);
  solver->add(block_of(o, Vec3::Zero(), Vec3(0.2, 0, 0.1)));
  advance_to(*solver, 1.5);
  const RestingForces resting = solver->resting_forces(true);
  EXPECT_NEAR(resting.forces[0].force.total().z() / (-1000 * 0.02 * g), 1, 1e-4);
  EXPECT_NEAR(resting.forces[0].pressed.pressure / (1000 * g * 0.1), 1, 0.05);
  EXPECT_NEAR(resting.forces[0].pressed.area, 0.24, 0.09);
}

/// A slab of dry snow on a slope that slides with the coefficient of the wall.
TEST(WallForces, SlidingSlabFollowsCoulomb) {
  Options o;
  o.dimension = 2;
  o.settings.spacing = 0.02;
  o.settings.friction_angle = 35;
  o.gravity = g * Vec3(0.5, 0, -std::sqrt(0.75));
  o.period = 0.4;
  o.forces = true;
  Obstacle slope = wall(Vec3::Zero(), Vec3::UnitZ());
  slope.law = {Condition::separate, 0.3};
  o.obstacles = {slope};
  const auto solver = make_solver(o);
  const ParticleBatch slab = block_of(o, Vec3::Zero(), Vec3(0.4, 0, 0.1));
  solver->add(slab);
  advance_to(*solver, 0.2);
  const auto forces = mean_forces(*solver, 0.5);
  EXPECT_NEAR(forces[0].push / (slab.total_mass() * g * std::sqrt(0.75)), 1, 0.005);
  EXPECT_NEAR(forces[0].tangential.norm() / forces[0].push / 0.3, 1, 0.005);
}

class StoredWallForces : public io::TemporaryFolder {};

TEST_F(StoredWallForces, ResumeToTheSameBits) {
  const Options o = named_tank(2, 0.2, 0.02);
  const auto solver = make_solver(o), fresh = make_solver(o);
  solver->add(block_of(o, Vec3::Zero(), Vec3(0.1, 0, 0.1)));
  advance_to(*solver, 0.1);
  io::BinaryWriter out;
  solver->save(out);
  out.save(path("state"));
  fresh->load(io::BinaryReader::load(path("state")));
  for (Solver* s : {solver.get(), fresh.get()}) advance_to(*s, 0.2);
  const auto a = solver->sample_forces(1), b = fresh->sample_forces(1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].impulse.total(), b[i].impulse.total());
    EXPECT_EQ(a[i].pressed.pressure, b[i].pressed.pressure);
  }
}

}  // namespace
}  // namespace snowshed::methods::mps
