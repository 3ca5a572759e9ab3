// Damping over a length: the same on any grid, for any number of threads, and balanced.
#include "snowshed/methods/mpm/velocity_average.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double length = 0.01, rate = 380;  // m, 1/s

Options damped_options(const SolverVariant& variant, double dx = 0.01) {
  Options o = options_for(variant, dx);
  o.settings.transfer = Transfer::affine_flip;
  o.settings.damping_length = length;
  o.settings.damping_rate = rate;
  o.gravity = 0;
  return o;
}

/// A chunk of snow, w by w/2 in the x-z plane (and w/2 along y), that turns about y.
void add_turning_chunk(Method& solver, int dimension, double w, double spacing, double angle,
                       double spin) {
  const Vec3 half(w / 2, w / 4, w / 4);
  const ParticleBatch box = filled_box(dimension, -half, half, spacing);
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  for (const Vec3& position : box.positions) {
    ParticleBatch particle;
    const Vec3 x = turn * position;
    particle.positions = {x + Vec3(0.003, 0, 0.302)};
    particle.velocity = spin * Vec3::UnitY().cross(x);
    particle.mass = box.mass;
    solver.add(particle);
  }
}

/// Angular momentum about y and the centre of mass, including that of affine velocities (inertia
/// dx^2/4).
double spin_momentum(const Method& solver, double dx) {
  const ParticleState s = solver.state();
  const Vec3 x = weighted_mean(s, s.positions), v = weighted_mean(s, s.velocities);
  const std::vector<double> affine = values_by_id(solver, "affine");
  double sum = 0;
  for (std::size_t i = 0; i < s.masses.size(); ++i) {
    sum += s.masses[i] * (s.positions[i] - x).cross(s.velocities[i] - v).y();
    sum += s.masses[i] * dx * dx / 4 * (affine[9 * i + 2] - affine[9 * i + 6]);
  }
  return sum;
}

/// Mean rate (1/s) at which the rotation of a chunk decays, over some orientations.
double decay_rate(int dimension, double w, double dx) {
  double sum = 0;
  const double angles[] = {0.4, 1.1, 2.0};
  for (const double angle : angles) {
    const auto solver = make_solver(damped_options({dimension, Precision::float32}, dx), {});
    add_turning_chunk(*solver, dimension, w, dx / std::sqrt(6.0), angle, 10);
    run_until(*solver, 0.01);
    const double before = spin_momentum(*solver, dx), begin = solver->time();
    run_until(*solver, 0.03);
    sum += std::log(before / spin_momentum(*solver, dx)) / (solver->time() - begin);
  }
  return sum / 3;
}

/// The same rate for a rigid body of points, without cells: `rate` times the share of angular
/// momentum that the average lacks. The coarse grid has random positions.
double exact_decay_rate(double w) {
  constexpr int n = 48;
  Random random(3);
  double sum = 0;
  for (int sample = 0; sample < 8; ++sample) {
    const double angle = 6.3 * random.uniform();
    const Vec3 shift = random_vector(random, 2, 1.0);
    const auto weights = [&](const Vec3& x, const auto& visit) {
      const Vec3 at = x / length + shift + Vec3(20, 0, 20);
      const int low_i = int(at.x()) - 1, low_k = int(at.z()) - 1;
      for (int i = low_i; i < low_i + 4; ++i)
        for (int k = low_k; k < low_k + 4; ++k) {
          const auto spline = [](double d) {
            const double a = std::abs(d);
            return a < 0.5 ? 0.75 - a * a : a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0.0;
          };
          const double weight = spline(at.x() - i) * spline(at.z() - k);
          if (weight > 0) visit(i * 40 + k, weight);
        }
    };
    std::vector<Vec3> points, momentum(1600, Vec3::Zero());
    std::vector<double> mass(1600, 0.0);
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n / 2; ++k)
        points.push_back(turn * Vec3((i + 0.5) / n - 0.5, 0, (k + 0.5) / n - 0.25) * w);
    const auto velocity = [](const Vec3& x) { return Vec3(Vec3::UnitY().cross(x)); };
    for (const Vec3& x : points)
      weights(x, [&](int node, double weight) {
        mass[node] += weight;
        momentum[node] += weight * velocity(x);
      });
    double total_spin = 0, averaged_spin = 0;
    for (const Vec3& x : points) {
      total_spin += x.cross(velocity(x)).y();
      weights(x, [&](int node, double weight) {
        averaged_spin += weight * x.cross(Vec3(momentum[node] / mass[node])).y();
      });
    }
    sum += rate * (1 - averaged_spin / total_spin);
  }
  return sum / 8;
}

TEST(VelocityAverage, RotationDecaysEquallyFastOnAnyGrid) {
  for (const double w : {0.02, 0.04, 0.08}) {
    double min_rate = 1e9, max_rate = 0;
    for (const double dx : {0.02, 0.01, 0.007, 0.005, 0.0025}) {
      // A chunk of one cell by half a cell has three particles. Their affine velocities have five
      // sixths of the angular momentum, which the average lacks.
      if (w < 1.5 * dx || w > 16 * dx) continue;
      const double rate = decay_rate(2, w, dx);
      min_rate = std::min(min_rate, rate);
      max_rate = std::max(max_rate, rate);
      if (w == 16 * dx || w == 8 * dx) EXPECT_NEAR(rate, exact_decay_rate(w), 0.08 * rate) << w;
    }
    EXPECT_LT(max_rate / min_rate, 1.1 / 0.9)
        << w << " m: " << min_rate << " to " << max_rate << " 1/s";
  }
}

TEST(VelocityAverage, RotationDecaysEquallyFastInThreeDimensions) {
  const double coarse = decay_rate(3, 0.04, 0.01), fine = decay_rate(3, 0.04, 0.005);
  EXPECT_NEAR(coarse / fine, 1.0, 0.1) << coarse << " and " << fine << " 1/s";
}

/// On cells larger than twice the length a smaller share of the average diffuses velocities equally
/// fast.
TEST(VelocityAverage, CoarseGridsDampLargeChunksEquallyFast) {
  const double fine_rate = decay_rate(2, 0.24, 0.02);
  EXPECT_NEAR(decay_rate(2, 0.24, 0.04), fine_rate, 0.2 * fine_rate);
}

TEST(VelocityAverage, DoesNotDependOnTheStep) {
  const auto decay_rate_at = [](double courant_factor) {
    Options o = damped_options({2, Precision::float64});
    o.settings.courant_factor = courant_factor;
    const auto solver = make_solver(o, {});
    add_turning_chunk(*solver, 2, 0.04, 0.004, 0.4, 10);
    run_until(*solver, 0.01);
    const double before = spin_momentum(*solver, 0.01), begin = solver->time();
    run_until(*solver, 0.03);
    return std::log(before / spin_momentum(*solver, 0.01)) / (solver->time() - begin);
  };
  const double expected = decay_rate_at(0.9);
  for (const double courant_factor : {0.45, 0.2})
    EXPECT_NEAR(decay_rate_at(courant_factor), expected, 0.06 * expected) << courant_factor;
}

/// A particle with random position, velocity and mass.
ParticleBatch swarm_particle(Random& random, int dimension) {
  ParticleBatch particle;
  particle.positions = {random_vector(random, dimension, 0.03)};
  particle.velocity = random_vector(random, dimension, 1.0);
  particle.mass = 1e-3 * (0.5 + random.uniform());
  return particle;
}

TEST(VelocityAverage, KeepsMomentumAndBalancesItsEnergy) {
  for (const SolverVariant& variant :
       {SolverVariant{2, Precision::float32}, SolverVariant{2, Precision::float64},
        SolverVariant{3, Precision::float32}, SolverVariant{3, Precision::float64}}) {
    for (const double dx : {0.004, 0.01, 0.03}) {
      Options o = damped_options(variant, dx);
      o.energy = true;
      const auto solver = make_solver(o, {});
      Random random(7);
      double speeds = 0;
      for (int i = 0; i < 120; ++i) {
        const ParticleBatch particle = swarm_particle(random, variant.dimension);
        solver->add(particle);
        speeds += particle.mass * particle.velocity.norm();
      }
      const Vec3 before = momentum(solver->state());
      const EnergyBalance start = energy_of(*solver);
      run_steps(*solver, 80);
      const Vec3 change = momentum(solver->state()) - before;
      EXPECT_LT(change.norm(), 80 * variant.epsilon() * speeds) << variant.name() << " " << dx;
      const EnergyBalance end = energy_of(*solver);
      EXPECT_GT(end.damping, 0.01 * start.kinetic) << variant.name() << " " << dx;
      EXPECT_NEAR(end.residual(), 0, 0.02 * start.kinetic) << variant.name() << " " << dx;
    }
  }
}

TEST(VelocityAverage, EnergyOfATurningChunkCloses) {
  Options o = damped_options({2, Precision::float64});
  o.energy = true;
  o.snows[0].model = material::SnowModel::elastic;
  const auto solver = make_solver(o, {});
  add_turning_chunk(*solver, 2, 0.04, 0.004, 0.4, 10);
  run_until(*solver, 0.02);
  const EnergyBalance e = energy_of(*solver);
  EXPECT_GT(e.damping, 0.5 * e.added);  // energy taken by the average, not by the transfer
  EXPECT_NEAR(e.residual(), 0, 0.01 * e.added);
}

/// Two particles at the same position that fly apart with 10 microjoules.
void add_parting_particles(Solver& solver) {
  for (const double speed : {0.1, -0.1}) {
    ParticleBatch particle;
    particle.positions = {Vec3(0.003, 0, 0.302)};
    particle.velocity = Vec3(speed, 0, 0);
    particle.mass = 1e-3;
    solver.add(particle);
  }
}

/// Damping at this rate stops both particles.
TEST(VelocityAverage, RecordsTheEnergyThatItTakes) {
  Options o = damped_options({2, Precision::float64});
  o.energy = true;
  o.settings.damping_rate = 1e9;
  const auto solver = make_solver(o, {});
  add_parting_particles(*solver);
  run_steps(*solver, steps_between_averages);
  const EnergyBalance e = energy_of(*solver);
  EXPECT_NEAR(e.added, 1e-5, 1e-11);
  EXPECT_NEAR(e.damping, e.added, 1e-6 * e.added);
  EXPECT_NEAR(e.kinetic, 0, 1e-6 * e.added);
}

/// Neither an average over a length far below a cell nor PIC takes energy.
TEST(VelocityAverage, AVanishingLengthTakesNoEnergy) {
  Options o = damped_options({2, Precision::float64});
  o.settings.damping_length = 1e-5;
  o.energy = true;
  const auto solver = make_solver(o, {});
  add_parting_particles(*solver);
  run_until(*solver, 0.01);
  EXPECT_NEAR(energy_of(*solver).kinetic, 1e-5, 1e-7);
}

TEST(VelocityAverage, DoesNotChangeUniformMotion) {
  Options o = damped_options({2, Precision::float64});
  const auto solver = make_solver(o, {});
  ParticleBatch batch = filled_box(2, Vec3(0, 0, 0), Vec3(0.05, 0, 0.05), 0.005);
  batch.velocity = Vec3(1, 0, -2);
  solver->add(batch);
  run_steps(*solver, 100);
  for (const Vec3& v : solver->state().velocities) ASSERT_LT((v - batch.velocity).norm(), 1e-11);
}

class VelocityAverageCheckpoint : public io::TemporaryFolder {};

std::unique_ptr<Solver> thrown_chunk(int threads) {
  Options o = damped_options({2, Precision::float32});
  o.gravity = 9.81;
  o.settings.threads = threads;
  o.settings.sleep_speed = 0.02;
  auto solver =
      make_solver(o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
  ParticleBatch below = filled_box(2, Vec3(-0.3, 0, 0), Vec3(0.3, 0, 0.04), 0.004);
  ParticleBatch above = filled_box(2, Vec3(-0.1, 0, 0.06), Vec3(0.1, 0, 0.1), 0.004);
  above.velocity = Vec3(1, 0, -1);
  solver->add(below);
  solver->add(above);
  return solver;
}

TEST_F(VelocityAverageCheckpoint, ThreadsAndResumingDoNotChangeTheBits) {
  const auto single = thrown_chunk(1), several = thrown_chunk(3);
  const auto run = [](Method& solver) {
    run_steps(solver, 1201);
    solver.add_velocity(std::vector<Vec3>(solver.size(), Vec3(0, 0, 1e-3)));  // a safe point
    run_steps(solver, 2);
  };
  run(*single);
  run(*several);
  expect_same_bits(snow_state(*several), snow_state(*single));
  EXPECT_GT(single->slept_updates(), 0);
  single->add_velocity(std::vector<Vec3>(single->size(), Vec3::Zero()));  // a safe point
  ASSERT_NE(single->counters().steps % steps_between_averages,
            0);  // part of the damping is pending
  expect_resumes(*single, *thrown_chunk(1), path("state"), 300);
}

/// A checkpoint does not contain the averages' sums of sleeping snow.
TEST_F(VelocityAverageCheckpoint, ResumesToTheSameBitsBesideSleepingSnow) {
  const auto solver = thrown_chunk(1);
  for (int i = 0; i < 4; ++i) {
    run_steps(*solver, 300);
    while (!solver->at_safe_point()) solver->step();
    expect_resumes(*solver, *thrown_chunk(1), path("state"), 20);
  }
  EXPECT_GT(solver->slept_updates(), 0);
}

}  // namespace
}  // namespace snowshed::methods::mpm
