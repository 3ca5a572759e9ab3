// Particles of several snows in one solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed::methods::mpm {
namespace {

material::Snow soft_snow() {
  material::Snow snow;
  snow.density = 120;
  snow.youngs_modulus = 2e5;
  return snow;
}

/// Snow thrown onto a slippery slope, in two halves of the materials 0 and `upper`, with the energy
/// balance.
std::unique_ptr<Solver> thrown_halves(const SolverVariant& variant,
                                      std::vector<material::Snow> snows, int upper, int threads = 1,
                                      bool energy_balance = true) {
  Options o = options_for(variant);
  o.snows = std::move(snows);
  o.settings.threads = threads;
  o.energy = energy_balance;
  auto solver =
      make_solver(o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3(0.5, 0, 1).normalized()),
                            Condition::separate, 0.3)});
  const double size = variant.dimension == 2 ? 0.12 : 0.05;
  for (int half : {0, 1}) {
    const int material_id = half * upper;
    ParticleBatch batch = filled_box(variant.dimension, Vec3(0, 0, 0.01 + half * size / 2),
                                     Vec3(size, size, 0.01 + (half + 1) * size / 2), 0.005,
                                     o.snows[std::size_t(material_id)].density);
    batch.velocity = Vec3(1, 0, -3);
    batch.material_id = material_id;
    solver->add(batch);
  }
  return solver;
}

/// The largest difference of a quantity, divided by its largest value.
template <class Values>
double relative_difference(const Values& a, const Values& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if constexpr (std::is_same_v<typename Values::value_type, Vec3>) {
      difference = std::max(difference, (a[i] - b[i]).norm());
      size = std::max(size, a[i].norm());
    } else {
      difference = std::max(difference, std::abs(a[i] - b[i]));
      size = std::max(size, std::abs(a[i]));
    }
  }
  return difference / size;
}

TEST(MaterialPerParticle, EqualMaterialsMoveLikeOne) {
  for (material::SnowModel model : {material::SnowModel::cam_clay, material::SnowModel::elastic})
    for (const SolverVariant& variant : all_solver_variants()) {
      SCOPED_TRACE(variant.name() + (model == material::SnowModel::elastic ? "_elastic" : ""));
      material::Snow snow;
      snow.model = model;
      const auto single = thrown_halves(variant, {snow}, 0, 1, false);
      const auto first_of_two = thrown_halves(variant, {snow, snow}, 0);
      const auto both = thrown_halves(variant, {snow, snow}, 1);
      for (Method* solver : {single.get(), first_of_two.get(), both.get()}) run_steps(*solver, 40);
      const SnowState a = snow_state(*single), b = snow_state(*first_of_two), c = snow_state(*both);
      expect_same_bits(b, c);
      EXPECT_EQ(energy_of(*first_of_two).residual(), energy_of(*both).residual());
      EXPECT_EQ(std::count(c.material_ids.begin(), c.material_ids.end(), 1),
                std::ptrdiff_t(c.material_ids.size() / 2));
      // Without the balance, a single snow has its own kernels, which may round differently.
      EXPECT_TRUE(a.material_ids.empty());
      const double round_off = 1000 * variant.epsilon();
      EXPECT_LT(relative_difference(a.positions, b.positions), round_off);
      EXPECT_LT(relative_difference(a.velocities, b.velocities), round_off);
      EXPECT_LT(relative_difference(a.pressures, b.pressures), 10 * round_off);
    }
}

TEST(MaterialPerParticle, ElasticSnowBesideYieldingSnowStaysElastic) {
  material::Snow elastic = soft_snow();
  elastic.model = material::SnowModel::elastic;
  material::Snow weak;
  weak.preconsolidation_pressure = 200;
  for (Precision precision : {Precision::float32, Precision::float64}) {
    const auto solver = thrown_halves({2, precision}, {weak, elastic}, 1);
    run_steps(*solver, 300);
    const SnowState s = snow_state(*solver);
    const SnowState initial = snow_state(*thrown_halves({2, precision}, {weak, elastic}, 1));
    std::size_t yielded = 0;
    for (std::size_t i = 0; i < s.material_ids.size(); ++i) {
      if (s.material_ids[i] == 1)
        EXPECT_EQ(s.plastic_strains[i], 0.0);
      else
        yielded += s.plastic_strains[i] != initial.plastic_strains[i];
      ASSERT_TRUE(std::isfinite(s.densities[i]));
    }
    EXPECT_GT(yielded, s.material_ids.size() / 8);
  }
}

TEST(MaterialPerParticle, TheStiffestPresentSnowLimitsTheStep) {
  Options o = options_for({2, Precision::float64});
  o.gravity = 0;
  o.snows = {soft_snow(), material::Snow()};
  const auto limit = [&](const material::Snow& s) {
    return o.settings.courant_factor * elastic_time_step(s.youngs_modulus, s.poissons_ratio,
                                                         s.density, 2, o.settings.dx,
                                                         Transfer::flip, Basis::quadratic);
  };
  ASSERT_LT(limit(o.snows[1]), 0.8 * limit(o.snows[0]));
  const auto solver = make_solver(o, {});
  solver->add(filled_box(2, Vec3::Zero(), Vec3(0.05, 0, 0.05), 0.005, 120));
  solver->step();
  EXPECT_DOUBLE_EQ(solver->time_step(), limit(o.snows[0]));
  ParticleBatch stiff = filled_box(2, Vec3(0, 0, 0.05), Vec3(0.05, 0, 0.1), 0.005, 210);
  stiff.material_id = 1;
  solver->add(stiff);
  solver->step();
  EXPECT_DOUBLE_EQ(solver->time_step(), limit(o.snows[1]));
}

TEST(MaterialPerParticle, TheStiffestSnowLimitsTheStepWhereverItIsListed) {
  Options o = options_for({2, Precision::float64});
  o.gravity = 0;
  double step[2];
  for (const int stiffest : {0, 1}) {
    o.snows = {soft_snow(), soft_snow()};
    o.snows[std::size_t(stiffest)] = material::Snow();
    const auto solver = make_solver(o, {});
    for (const int material_id : {0, 1}) {
      const double x = 0.05 * material_id;
      ParticleBatch batch = filled_box(2, Vec3(x, 0, 0), Vec3(x + 0.05, 0, 0.05), 0.005, 210);
      batch.material_id = material_id;
      solver->add(batch);
    }
    solver->step();
    step[stiffest] = solver->time_step();
  }
  EXPECT_DOUBLE_EQ(step[0], step[1]);
}

TEST(MaterialPerParticle, AColumnOfTwoSnowsSettlesPiecewise) {
  // Elastic snow stands on a sticky floor between frictionless walls, and the lower layer carries
  // the upper one. With s = lambda + 2 mu of each layer, u' = g (rho_1 (h_1 - z) + rho_2 h_2)/s_1
  // in the lower layer, and u' = g rho_2 (H - z)/s_2 in the upper one. The snow vibrates about this
  // state. Its average over many of the longest periods is the static state.
  constexpr double half = 0.1, dx = 0.0025, width = 4 * dx, bin = 0.01, g = 9.81;
  Options o = options_for({2, Precision::float64}, dx);
  o.snows.assign(2, material::Snow());
  for (material::Snow& snow : o.snows) snow.model = material::SnowModel::elastic;
  o.snows[0].density = 300;
  o.snows[0].youngs_modulus = 3e5;
  o.snows[1].density = 100;
  o.snows[1].youngs_modulus = 1e5;
  o.snows[1].poissons_ratio = 0.1;
  const auto stiffness = [](const material::Snow& s) {
    const double nu = s.poissons_ratio;
    return s.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  };
  const auto solver = make_solver(
      o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky),
          fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitX()), Condition::separate),
          fixed(geometry::make_plane(Vec3(width, 0, 0), -Vec3::UnitX()), Condition::separate)});
  for (int material_id : {0, 1}) {
    ParticleBatch layer =
        filled_box(2, Vec3(0, 0, material_id * half), Vec3(width, 0, (material_id + 1) * half),
                   dx / 2, o.snows[std::size_t(material_id)].density);
    layer.material_id = material_id;
    solver->add(layer);
  }
  const ParticleState start = solver->state();
  std::vector<double> settlement(start.positions.size());
  const double duration = 40 * half / std::sqrt(stiffness(o.snows[1]) / o.snows[1].density);
  average(*solver, duration, [&](double part, const ParticleState& now) {
    for (std::size_t i = 0; i < settlement.size(); ++i)
      settlement[i] += part * (start.positions[i].z() - now.positions[i].z());
  });
  const double w1 = 300 * g / stiffness(o.snows[0]), w2 = 100 * g / stiffness(o.snows[0]);
  const double w3 = 100 * g / stiffness(o.snows[1]);
  const auto below = [&](double z) { return w1 * (half * z - z * z / 2) + w2 * half * z; };
  const auto expected = [&](double z) {
    const double up = z - half;
    return up < 0 ? below(z) : below(half) + w3 * (half * up - up * up / 2);
  };
  const double top = expected(2 * half);
  for (double z = bin / 2; z < 2 * half; z += bin) {
    double mean = 0, particles = 0;
    for (std::size_t i = 0; i < settlement.size(); ++i) {
      if (std::abs(start.positions[i].z() - z) > bin / 2) continue;
      mean += settlement[i];
      ++particles;
    }
    EXPECT_NEAR(mean / particles, expected(z), 0.01 * top) << z;
  }
}

TEST(MaterialPerParticle, EnergyBalanceCloses) {
  for (const SolverVariant& variant : {SolverVariant{2, Precision::float32},
                                       SolverVariant{2, Precision::float64, Transfer::apic}}) {
    Options o = options_for(variant);
    o.energy = true;
    o.snows = {material::Snow(), soft_snow()};
    for (material::Snow& snow : o.snows) snow.preconsolidation_pressure = 200;  // too weak to stand
    o.snows[1].cohesion = 0;
    const auto solver = make_solver(
        o, {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky)});
    for (int material_id : {0, 1}) {
      ParticleBatch layer =
          filled_box(2, Vec3(0, 0, 0.12 * material_id), Vec3(0.05, 0, 0.12 * (material_id + 1)),
                     0.005, o.snows[std::size_t(material_id)].density);
      layer.velocity.x() = 0.5;
      layer.material_id = material_id;
      solver->add(layer);
    }
    const EnergyBalance start = energy_of(*solver);
    EXPECT_NEAR(start.gravitational, 9.81 * 0.05 * 0.12 * (210 * 0.06 + 120 * 0.18), 1e-5);
    run_until(*solver, 0.2);
    const EnergyBalance end = energy_of(*solver);
    const double turnover = start.gravitational - end.gravitational;
    EXPECT_GT(end.plastic, 0.05 * turnover) << variant.name();
    EXPECT_NEAR(end.residual(), 0.0, 0.02 * turnover) << variant.name();
  }
}

TEST(MaterialPerParticle, ElasticEnergyUsesTheSnowOfEachParticle) {
  // The energy that add() counts must be the energy that the kernels record.
  const auto solver = thrown_halves({2, Precision::float64}, {material::Snow(), soft_snow()}, 1);
  run_steps(*solver, 100);
  const double recorded = energy_of(*solver).elastic;
  ParticleBatch grain;
  grain.positions = {Vec3(1, 0, 1)};
  grain.mass = 1e-9;
  solver->add(grain);
  EXPECT_GT(recorded, 1e-3);
  EXPECT_NEAR(energy_of(*solver).elastic, recorded, 1e-9 * recorded);
}

TEST(MaterialPerParticle, ThreadsDoNotChangeTheBits) {
  const SolverVariant variant{2, Precision::float32};
  const auto single = thrown_halves(variant, {material::Snow(), soft_snow()}, 1);
  const auto two = thrown_halves(variant, {material::Snow(), soft_snow()}, 1, 2);
  run_steps(*single, 150);
  run_steps(*two, 150);
  EXPECT_GT(single->sorts(), 1);
  expect_same_bits(snow_state(*two), snow_state(*single));
  EXPECT_EQ(two->state().material_ids, single->state().material_ids);
  EXPECT_EQ(energy_of(*two).residual(), energy_of(*single).residual());
}

}  // namespace
}  // namespace snowshed::methods::mpm
