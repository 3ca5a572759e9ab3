// Snow that yields in the complete solver, compared with closed forms. It breaks at the strength of
// the law only if constants, kernels and transfer are all right.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "material/rate_integration.hpp"
#include "methods/mpm/solver_testing.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Snow whose law has a closed form, because uniaxial stress causes no lateral strain.
material::Snow test_snow() {
  material::Snow snow;
  snow.poissons_ratio = 0;
  snow.critical_state_slope = 1.5;
  return snow;
}

material::LawConstants constants_of(const material::Snow& s) {
  return {s.youngs_modulus, s.poissons_ratio, s.critical_state_slope, s.cohesion,
          s.hardening_factor};
}

// --- hanging column ---------------------------------------------------------------------------

/// Uniaxial tension at which snow yields, Pa: the root of (1.2.6) for p = -s/D and q = s (in space)
/// or s sqrt(3)/2 (in the plane, whose law uses the invariants of two dimensions).
double tensile_strength(const material::Snow& snow, int dimension) {
  const double p0 = snow.preconsolidation_pressure, beta = snow.cohesion;
  const double m2 = snow.critical_state_slope * snow.critical_state_slope;
  const double q_squared = dimension == 2 ? 0.75 : 1.0, p = 1.0 / dimension;
  const double a = (1 + 2 * beta) * q_squared + m2 * p * p, b = m2 * (1 - beta) * p * p0;
  const double c = -m2 * beta * p0 * p0;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

constexpr double column_length = 0.2;

/// Fall of the lower quarter of a column that hangs from a sticky ceiling. Its weight grows slowly
/// until the pull on the ceiling is a part of the column's strength, and then stays constant.
double fall_of_column(int dimension, double part_of_strength) {
  Options o = options_for({dimension, Precision::float32});
  material::Snow& snow = o.snows[0] = test_snow();
  const double stress = part_of_strength * tensile_strength(snow, dimension);
  o.gravity = stress / (snow.density * column_length);
  const auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), -Vec3::UnitZ()), Condition::sticky)});
  const double width = dimension == 2 ? 0.06 : 0.03;
  solver->add(filled_box(dimension, Vec3(0, 0, -column_length), Vec3(width, width, 0), 0.005));
  const double period = 4 * column_length / std::sqrt(snow.youngs_modulus / snow.density);
  const auto middle = [&] {
    const ParticleState s = solver->state();
    double sum = 0, count = 0;
    for (const Vec3& x : s.positions)
      if (x.z() < -0.75 * column_length) sum += x.z(), ++count;
    return sum / count;
  };
  const double before = middle();
  while (solver->time() < 6 * period && before - middle() < 0.01) {
    solver->step();
    const double missing = std::max(0.0, 1 - solver->time() / (3 * period));
    const Vec3 lift(0, 0, missing * o.gravity * solver->time_step());
    if (missing > 0) solver->add_velocity(std::vector<Vec3>(solver->size(), lift));
  }
  return before - middle();
}

/// The column breaks a little early, because the stress of particles scatters about that of the
/// column.
TEST(HangingColumn, BreaksAtItsTensileStrength) {
  for (int dimension : {2, 3}) {
    EXPECT_LT(fall_of_column(dimension, 0.85), 5e-4) << dimension;
    EXPECT_GT(fall_of_column(dimension, 0.98), 5e-3) << dimension;
  }
}

// --- homogeneous strain -----------------------------------------------------------------------

struct Stress {
  double p, q;
};

/// Mean stress within two cells of the origin.
Stress stress_at_middle(const Method& solver, const material::Snow& snow, int dimension) {
  const double mu = snow.youngs_modulus / (2 * (1 + snow.poissons_ratio));
  const double lambda = 2 * mu * snow.poissons_ratio / (1 - 2 * snow.poissons_ratio);
  const particles::FieldView positions = solver.field("position");
  std::vector<std::pair<std::string, particles::FieldView>> strains;
  for (const particles::FieldInfo& info : solver.fields())
    if (info.name.rfind("be_minus_identity", 0) == 0)
      strains.emplace_back(info.name.substr(info.name.size() - 2), solver.field(info.name));
  Stress mean{0, 0};
  double count = 0;
  for (std::size_t i = 0; i < positions.count; ++i) {
    const double* x = positions.at<double>(i);
    if (std::abs(x[0]) > 0.02 || std::abs(x[1]) > 0.02 || std::abs(x[2]) > 0.02) continue;
    Mat3 b = Mat3::Identity();
    for (const auto& [axes, view] : strains)
      b(axes[0] - 'x', axes[1] - 'x') = b(axes[1] - 'x', axes[0] - 'x') =
          *view.at<double>(i) + (axes[0] == axes[1] ? 1.0 : 0.0);
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(b);
    const Vec3 log_stretch = 0.5 * eigen.eigenvalues().array().log();
    const Mat3 e =
        eigen.eigenvectors() * log_stretch.asDiagonal() * eigen.eigenvectors().transpose();
    const double p = -(lambda + 2 * mu / dimension) * e.trace();
    Mat3 s = 2 * mu * e;
    for (int k = 0; k < 3; ++k)
      if (dimension == 3 || k != 1) s(k, k) += lambda * e.trace() + p;
    mean.p += p;
    mean.q += std::sqrt(1.5) * s.norm();
    ++count;
  }
  return {mean.p / count, mean.q / count};
}

/// A block about the origin in which the velocity is `gradient` times the position. Waves from its
/// faces reach the middle only after the measurements.
std::unique_ptr<Solver> straining_block(const material::Snow& snow, int dimension,
                                        const Mat3& gradient) {
  Options o = options_for({dimension, Precision::float64});
  o.gravity = 0;
  o.settings.dx = 0.02;
  o.settings.courant_factor = 0.1;
  o.snows[0] = snow;
  auto solver = make_solver(o, {});
  const ParticleBatch block =
      filled_box(dimension, Vec3::Constant(-0.1), Vec3::Constant(0.1), 0.01);
  std::vector<ParticleBatch> particles;
  for (const Vec3& x : block.positions) {
    ParticleBatch& particle = particles.emplace_back();
    particle.positions = {x};
    particle.mass = block.mass;
    particle.velocity = gradient * x;
    if (dimension == 2) particle.velocity.y() = 0;
  }
  solver->add(particles);
  return solver;
}

TEST(PlaneShear, FollowsTheLawBeyondYield) {
  for (int dimension : {2, 3}) {
    material::Snow snow = test_snow();
    snow.hardening_factor = 2;  // so that hardening shows within small strains
    snow.preconsolidation_pressure = 3e3;
    const double rate = 8;  // 1/s
    Mat3 gradient = Mat3::Zero();
    gradient(0, 2) = rate;
    const auto solver = straining_block(snow, dimension, gradient);
    const material::RateEquations law(constants_of(snow), dimension);
    const double ev = -std::asinh(snow.preconsolidation_pressure / law.hardening) / 2;
    for (const double time : {0.4e-3, 0.6e-3, 0.8e-3}) {
      run_until(*solver, time);
      const double strain = rate * solver->time() / 2;
      const auto exact = [&](auto zero) -> Stress {
        constexpr int D = decltype(zero)::RowsAtCompileTime;
        Eigen::Matrix<double, D, D> path = zero;
        path(0, D - 1) = path(D - 1, 0) = strain;
        const auto end = law.integrate<D>({zero, ev}, path);
        return {law.p<D>(end.strain), law.q<D>(end.strain)};
      };
      const Stress expected = dimension == 2 ? exact(Eigen::Matrix2d(Eigen::Matrix2d::Zero()))
                                             : exact(Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
      const Stress measured = stress_at_middle(*solver, snow, dimension);
      EXPECT_NEAR(measured.q, expected.q, 0.01 * expected.q) << dimension << "D " << time;
      EXPECT_NEAR(measured.p, expected.p, 0.015 * expected.q) << dimension << "D " << time;
    }
  }
}

TEST(IsotropicTension, BreaksSnowAtBetaTimesP0) {
  for (int dimension : {2, 3}) {
    const material::Snow snow = test_snow();
    const auto solver = straining_block(snow, dimension, 3 * Mat3::Identity());
    double min_pressure = 0;
    while (solver->time() < 1e-3) {
      solver->step();
      min_pressure = std::min(min_pressure, stress_at_middle(*solver, snow, dimension).p);
    }
    const double strength = snow.cohesion * snow.preconsolidation_pressure;
    EXPECT_NEAR(min_pressure, -strength, 0.01 * strength) << dimension;
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
