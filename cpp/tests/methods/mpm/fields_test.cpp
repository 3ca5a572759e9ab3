#include <algorithm>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/material/cam_clay.hpp"
#include "snowshed/methods/quantities.hpp"

namespace snowshed::methods::mpm {
namespace {

class ParticleFields : public testing::TestWithParam<SolverVariant> {
 protected:
  ParticleFields() : solver_(make_solver(options_for(GetParam()), {})) {
    solver_->add(
        filled_box(GetParam().dimension, Vec3(-0.03, -0.03, 1.0), Vec3(0.05, 0.03, 1.1), 0.005));
    shake(0.5);
  }

  /// Gives the particles random velocities up to a speed (m/s), and takes some steps.
  void shake(double speed) {
    std::vector<Vec3> changes;
    Random random(1);
    for (std::size_t i = 0; i < solver_->size(); ++i)
      changes.push_back(random_vector(random, GetParam().dimension, speed));
    solver_->add_velocity(changes);
    run_steps(*solver_, 80);
  }

  std::unique_ptr<Solver> solver_;
};

/// Every field, in the order of ids, has the same bits as the state.
TEST_P(ParticleFields, AgreeWithTheState) {
  const ParticleState state = solver_->state();
  const auto expect = [&](const char* name, const auto& expected) {
    const particles::FieldView view = solver_->field(name);
    ASSERT_EQ(view.count, expected.size());
    for (std::size_t k = 0; k < view.count; ++k) {
      const std::size_t index = solver_->order_by_id()[k];
      const auto* values = reinterpret_cast<const double*>(&expected[k]);
      for (int c = 0; c < view.info.components; ++c)
        particles::with_field_type(view.info.type, [&](auto zero) {
          EXPECT_EQ(double(view.at<decltype(zero)>(index)[c]), values[c]) << name;
        });
    }
  };
  expect("position", state.positions);
  expect("velocity", state.velocities);
  expect("mass", state.masses);
  expect("density", state.densities);
  const double initial_density = options_for(GetParam()).snows.front().density;
  const std::vector<double> volume_ratios = values_by_id(*solver_, "volume_ratio");
  for (std::size_t k = 0; k < volume_ratios.size(); ++k)
    EXPECT_DOUBLE_EQ(state.densities[k], initial_density / volume_ratios[k]);
  EXPECT_TRUE(std::is_sorted(state.ids.begin(), state.ids.end()));
}

/// All stresses lie within or on the yield surface of the law, and some lie on it.
TEST_P(ParticleFields, StressesLieWithinTheYieldSurface) {
  shake(10.0);  // so that snow yields
  const SnowState state = snow_state(*solver_);
  const int dimension = GetParam().dimension;
  const material::Snow snow = options_for(GetParam()).snows.front();
  const auto law = material::CamClay<double>::from(snow.youngs_modulus, snow.poissons_ratio,
                                                   snow.critical_state_slope, snow.cohesion,
                                                   snow.hardening_factor, dimension);
  const particles::FieldView q = solver_->field("deviatoric_stress");
  const particles::FieldView strength = solver_->field("preconsolidation_pressure");
  double max_yield = -1;  // y over M^2 p0^2; at least -1/4 within the surface
  for (std::size_t k = 0; k < q.count; ++k) {
    const std::size_t index = solver_->order_by_id()[k];
    const double p0 = *strength.at<double>(index);
    EXPECT_NEAR(p0, law.preconsolidation(state.plastic_strains[k]), 1e-9 * p0);
    const material::PQ<double> stress{state.pressures[k], *q.at<double>(index)};
    max_yield = std::max(max_yield, law.yield(stress, p0) / (law.m2 * p0 * p0));
  }
  EXPECT_NEAR(max_yield, 0.0, 5e-3);  // to rounding in single precision
}

TEST_P(ParticleFields, EveryFieldIsAListedQuantity) {
  const std::vector<Quantity> all = quantities();
  for (const particles::FieldInfo& info : solver_->fields()) {
    const auto known = [&](const Quantity& q) {
      return info.name.compare(0, q.name.size(), q.name) == 0 && info.unit == q.unit;
    };
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), known)) << info.name;
    EXPECT_EQ(solver_->field(info.name).count, solver_->size()) << info.name;
  }
  EXPECT_THROW(solver_->field("masss"), InputError);
}

/// Added particles are the last in the order of ids.
TEST_P(ParticleFields, AddedParticlesComeLastInTheOrder) {
  const std::size_t old = solver_->order_by_id().size();
  solver_->add(
      filled_box(GetParam().dimension, Vec3(-0.1, -0.03, 1.0), Vec3(-0.05, 0.03, 1.1), 0.01));
  const std::vector<std::uint32_t>& order = solver_->order_by_id();
  ASSERT_GT(order.size(), old);
  const particles::FieldView ids = solver_->field("id");
  for (std::size_t k = 0; k < order.size(); ++k)
    ASSERT_EQ(*ids.at<std::uint32_t>(order[k]), std::uint32_t(k));
}

INSTANTIATE_TEST_SUITE_P(Variants, ParticleFields, testing::ValuesIn(all_solver_variants()),
                         [](const auto& info) { return info.param.name(); });

}  // namespace
}  // namespace snowshed::methods::mpm
