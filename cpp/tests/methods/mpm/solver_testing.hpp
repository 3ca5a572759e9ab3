// Shared parts of the tests of the solver: options, blocks of particles, and sums over them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/random.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/advance.hpp"
#include "snowshed/methods/fields_by_id.hpp"
#include "snowshed/methods/mpm/describe.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {

/// A variant of the solver, for parameterised tests.
struct SolverVariant {
  int dimension;
  Precision precision;
  Transfer transfer = Transfer::flip;
  Basis basis = Basis::quadratic;

  double epsilon() const { return precision == Precision::float32 ? 1.2e-7 : 2.2e-16; }
  std::string name() const {
    return std::to_string(dimension) + "D_" +
           (precision == Precision::float32 ? "float" : "double") + "_" + name_of(transfer) +
           (basis == Basis::quadratic ? "_quadratic" : "_cubic");
  }
};

/// All combinations of dimension, precision, transfer and basis.
inline std::vector<SolverVariant> all_solver_variants() {
  std::vector<SolverVariant> variants;
  for (int dimension : {2, 3})
    for (Precision precision : {Precision::float32, Precision::float64})
      for (Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::affine_flip})
        for (Basis basis : {Basis::quadratic, Basis::cubic})
          variants.push_back({dimension, precision, transfer, basis});
  return variants;
}

inline Options options_for(const SolverVariant& variant, double dx = 0.01) {
  Options o;
  o.dimension = variant.dimension;
  o.settings.dx = dx;
  o.settings.precision = variant.precision;
  o.settings.transfer = variant.transfer;
  o.settings.basis = variant.basis;
  o.settings.threads = 1;
  o.settings.sleep_speed = 0;  // most of these tests are about small motions
  return o;
}

inline std::unique_ptr<Solver> make_solver(Options o, std::vector<Obstacle> obstacles) {
  o.obstacles = std::move(obstacles);
  return make_solver(std::move(o));
}

inline Obstacle fixed(geometry::Shape shape, Condition condition, double friction = 0.0) {
  return {"obstacle", std::move(shape), {condition, friction}, std::nullopt};
}

/// Particles that fill the box between two corners on a regular lattice of about the given
/// spacing, with the mass of snow of the given density.
inline ParticleBatch filled_box(int dimension, const Vec3& low, const Vec3& high, double spacing,
                                double density = 210.0) {
  ParticleBatch batch;
  int n[3];
  Vec3 step;
  for (int d = 0; d < 3; ++d) {
    n[d] =
        d == 1 && dimension == 2 ? 1 : std::max(1, int(std::lround((high[d] - low[d]) / spacing)));
    step[d] = (high[d] - low[d]) / n[d];
  }
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k)
        batch.positions.push_back(low + Vec3((i + 0.5) * step[0],
                                             dimension == 2 ? 0.0 : (j + 0.5) * step[1],
                                             (k + 0.5) * step[2]));
  batch.mass = density * step[0] * step[2] * (dimension == 2 ? 1.0 : step[1]);
  return batch;
}

/// Adds a disc in the x-z plane, around the origin, whose particles turn about y at `rate` (rad/s).
inline void add_spinning_disc(Method& solver, double radius, double rate, double spacing) {
  const ParticleBatch box =
      filled_box(2, Vec3(-radius, 0, -radius), Vec3(radius, 0, radius), spacing);
  for (const Vec3& x : box.positions) {
    if (x.norm() > radius) continue;
    ParticleBatch particle;
    particle.positions = {x};
    particle.velocity = rate * Vec3::UnitY().cross(x);
    particle.mass = box.mass;
    solver.add(particle);
  }
}

/// A vector with components within [-size, size], in the plane y = 0 in 2D.
inline Vec3 random_vector(Random& random, int dimension, double size) {
  Vec3 v;
  for (int d = 0; d < 3; ++d) v[d] = size * (2 * random.uniform() - 1);
  if (dimension == 2) v[1] = 0;
  return v;
}

/// The energy balance of a solver.
inline EnergyBalance energy_of(const Solver& solver) {
  std::map<std::string, double> joules;
  for (const auto& [name, value] : solver.energies()) joules[name] = value;
  EnergyBalance e;
  e.kinetic = joules.at("kinetic_j");
  e.gravitational = joules.at("gravitational_j");
  e.elastic = joules.at("elastic_j");
  e.plastic = joules.at("plastic_j");
  e.friction = joules.at("friction_j");
  e.sticking = joules.at("sticking_j");
  e.impact = joules.at("impact_j");
  e.transfer = joules.at("transfer_j");
  e.sleep = joules.at("sleep_j");
  e.damping = joules.at("damping_j");
  e.added = joules.at("added_j");
  return e;
}

inline void run_until(Method& solver, double time) { advance_to(solver, time); }

inline void run_steps(Method& solver, int steps) {
  for (int i = 0; i < steps; ++i) solver.step();
}

/// The particles, with quantities that only this method has.
struct SnowState : ParticleState {
  std::vector<double> pressures;        // Kirchhoff, Pa, compression positive
  std::vector<double> volume_ratios;    // current over initial volume
  std::vector<double> plastic_strains;  // volumetric, compaction negative
};

inline SnowState snow_state(const Method& solver) {
  return {solver.state(), values_by_id(solver, "pressure"), values_by_id(solver, "volume_ratio"),
          values_by_id(solver, "volumetric_plastic_strain")};
}

/// Averages the states of vibrating snow over a duration, which gives its static state. Calls `add`
/// with each state and its weight in the average. The weights, 2 sin^2 of the time, filter out all
/// modes that are several times shorter than the duration.
template <class Add>
void average(Method& solver, double duration, const Add& add) {
  double covered = 0;
  while (solver.time() < duration) {
    run_steps(solver, 8);
    const double middle = (covered + solver.time()) / 2;
    const double weight = 2 * std::pow(std::sin(pi * middle / duration), 2);
    add((solver.time() - covered) / duration * weight, snow_state(solver));
    covered = solver.time();
  }
}

inline double total_mass(const ParticleState& s) {
  double sum = 0;
  for (double m : s.masses) sum += m;
  return sum;
}

/// Mean of a particle quantity, weighted by mass.
inline Vec3 weighted_mean(const ParticleState& s, const std::vector<Vec3>& values) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) sum += s.masses[i] * values[i];
  return sum / total_mass(s);
}

inline Vec3 mean_velocity(const Method& solver) {
  const ParticleState s = solver.state();
  return weighted_mean(s, s.velocities);
}

inline void expect_same_bits(const SnowState& a, const SnowState& b) {
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_EQ(a.pressures, b.pressures);
  EXPECT_EQ(a.plastic_strains, b.plastic_strains);
  EXPECT_EQ(a.ids, b.ids);
}

/// Saves a solver to `file`, loads the file into a fresh solver, and expects the same bits of both
/// after further steps.
inline void expect_resumes(Solver& solver, Solver& fresh, const std::string& file, int steps) {
  io::BinaryWriter out;
  solver.save(out);
  out.save(file);
  fresh.load(io::BinaryReader::load(file));
  run_steps(solver, steps);
  run_steps(fresh, steps);
  expect_same_bits(snow_state(fresh), snow_state(solver));
}

inline Vec3 momentum(const ParticleState& s) {
  return total_mass(s) * weighted_mean(s, s.velocities);
}

}  // namespace snowshed::methods::mpm
