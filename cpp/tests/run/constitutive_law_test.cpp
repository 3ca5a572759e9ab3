// Constitutive laws of the user: stress and state from the elastic trial, as tensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/user_laws.hpp"

namespace snowshed::run {
namespace {

using methods::UserLaws;
using methods::mpm::Precision;

/// The law of the snow itself, with packs as the kernels of this build.
template <class T, int D>
void snow_itself(std::int64_t count, T* strain, T* stress, T* plastic, T*, const std::uint8_t*,
                 double time_step) {
  static const material::Snow snow;
  static const auto law = material::CamClay<T>::from(snow.youngs_modulus, snow.poissons_ratio,
                                                     snow.critical_state_slope, snow.cohesion,
                                                     snow.hardening_factor, D);
  using V = SimdPack<T>;
  using Tensor = material::Sym<V, D>;
  const int n = int(count);
  const auto& el = law.elastic;
  Tensor e;
  for (int k = 0; k < Tensor::size; ++k) e.c[k] = load(strain + k * n, n);
  const V volumetric = material::trace(e);
  V third = volumetric * (T(1) / T(D));
  Tensor dev = e;
  for (int k = 0; k < D; ++k) dev.c[k] -= third;
  V ratio = broadcast<V>(T(1));
  const V p_trial = -el.bulk * volumetric;
  const V q_trial = sqrt(V(T(6) * material::norm_squared(dev))) * el.mu;
  material::PQ<V> pq{p_trial, q_trial};
  V state = load(plastic, n);
  if (time_step > 0 && law.return_map(pq, state)) {
    const auto sheared = q_trial > T(0);
    ratio = select(sheared, V(pq.q / select(sheared, q_trial, ratio)), ratio);
    third = pq.p * (T(-1) / (el.bulk * T(D)));
    const auto changed = (pq.p != p_trial) | (pq.q != q_trial);
    for (int k = 0; k < Tensor::size; ++k) {
      V value = ratio * dev.c[k];
      if (k < D) value += third;
      store(strain + k * n, select(changed, value, e.c[k]), n);
    }
    store(plastic, state, n);
  }
  const V scale = T(2) * el.mu * ratio;
  for (int k = 0; k < Tensor::size; ++k) {
    V value = scale * dev.c[k];
    if (k < D) value -= pq.p;
    store(stress + k * n, value, n);
  }
}

/// A liquid that counts its steps, adds their durations, and stores its stress and its snow.
template <class T>
void count_steps(std::int64_t n, T* e, T* stress, T*, T* own, const std::uint8_t* snow, double dt) {
  for (std::int64_t i = 0; i < n; ++i) {
    stress[i] = stress[n + i] = T(1e6) * (e[i] + e[n + i]);
    stress[2 * n + i] = 0;
    if (dt > 0) own[i] += 1;
    own[n + i] += T(dt);
    if (dt > 0) own[2 * n + i] = stress[i];
    own[3 * n + i] = T(snow[i]);
  }
}

/// Elasticity with moduli of its own, which stores its stress.
template <int D>
void soft(std::int64_t n, double* e, double* stress, double*, double* own, const std::uint8_t*,
          double dt) {
  constexpr double bulk = 2e5, shear = 1.1e5;
  for (std::int64_t i = 0; i < n; ++i) {
    double volumetric = 0;
    for (int k = 0; k < D; ++k) volumetric += e[k * n + i];
    for (int k = 0; k < D * (D + 1) / 2; ++k) {
      const double third = k < D ? volumetric / D : 0;
      stress[k * n + i] = 2 * shear * (e[k * n + i] - third) + (k < D ? bulk * volumetric : 0);
      if (dt > 0) own[k * n + i] = stress[k * n + i];
    }
  }
}

std::atomic<std::int64_t> returned{0}, asked_again{0};

/// A liquid of Maxwell's kind: shear is lost at once, and a thousandth of the
/// volumetric strain in each step.
void flowing(std::int64_t n, double* e, double* stress, double* plastic, double* own,
             const std::uint8_t*, double dt) {
  (dt > 0 ? returned : asked_again) += n;
  for (std::int64_t i = 0; i < n; ++i) {
    const double volumetric = e[i] + e[n + i];
    const double left = dt > 0 ? 0.999 * volumetric : volumetric;
    stress[i] = stress[n + i] = 1e6 * left;
    stress[2 * n + i] = 0;
    if (!(dt > 0)) continue;
    e[i] = e[n + i] = 0.5 * left;
    e[2 * n + i] = 0;
    plastic[i] += volumetric - left;
    own[i] += volumetric - left;
    own[n + i] = left;
  }
}

/// Linear elasticity without resistance to shear.
void liquid(std::int64_t n, double* e, double* stress, double*, double*, const std::uint8_t*,
            double) {
  for (std::int64_t i = 0; i < n; ++i) {
    stress[i] = stress[n + i] = 1e6 * (e[i] + e[n + i]);
    stress[2 * n + i] = 0;
  }
}

UserLaws with(void* law, int own_numbers = 0) {
  UserLaws laws;
  laws.name = "tensors";
  laws.constitutive = law;
  laws.own_numbers = own_numbers;
  return laws;
}

scene::Scene one_event(Precision precision = Precision::float64) {
  scene::Scene scene = small_scene();
  scene.events.count = 1;
  scene.output.energy = false;
  scene.numerics.as<methods::mpm::Settings>().precision = precision;
  return scene;
}

void expect_same_bits(const scene::Scene& scene, const UserLaws& laws, int steps) {
  Simulation mine(scene, ".", laws), own(scene);
  for (Simulation* sim : {&mine, &own}) {
    sim->begin_event();
    sim->step(steps);
  }
  const auto a = mine.method().state(), b = own.method().state();
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.velocities == b.velocities);
  EXPECT_TRUE(a.densities == b.densities);
  expect_yielded(mine);
}

TEST(ConstitutiveLaw, TheLawOfTheSnowGivesTheSameBits) {
  if (std::string(kernel_variant_name()) != "baseline")
    GTEST_SKIP() << "needs the kernels of this file: SNOWSHED_KERNELS=baseline";
  const auto of = [](auto* law) { return with(reinterpret_cast<void*>(law)); };
  expect_same_bits(falling_box(2, Precision::float32), of(&snow_itself<float, 2>), 1500);
  expect_same_bits(falling_box(2, Precision::float64), of(&snow_itself<double, 2>), 1500);
  expect_same_bits(falling_box(3, Precision::float32), of(&snow_itself<float, 3>), 400);
  expect_same_bits(falling_box(3, Precision::float64), of(&snow_itself<double, 3>), 400);
}

TEST(ConstitutiveLaw, ReplacesLawAndElasticity) {
  const auto laws = with(reinterpret_cast<void*>(&liquid));
  Simulation mine(one_event(), ".", laws), own(one_event());
  for (Simulation* sim : {&mine, &own}) {
    sim->begin_event();
    sim->step(600);
  }
  EXPECT_FALSE(mine.method().state().positions == own.method().state().positions);
  const auto shear = mine.method().field("deviatoric_stress");
  const auto* values = static_cast<const double*>(shear.elements.get());
  for (std::size_t i = 0; i < shear.count; ++i) EXPECT_EQ(values[i], 0.0);
}

template <class T>
std::vector<double> field_of(const Simulation& sim, const std::string& name) {
  const auto view = sim.method().field(name);
  const auto* values = static_cast<const T*>(view.elements.get());
  return {values, values + view.count};
}

template <class T>
void expect_counted_steps(Precision precision) {
  scene::Scene scene = falling_box(2, precision);
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0;
  const auto law = reinterpret_cast<void*>(&count_steps<T>);
  Simulation sim(scene, ".", with(law, 4));
  sim.begin_event();
  sim.step(400);  // several sorts
  for (const double steps : field_of<T>(sim, "own_0")) EXPECT_EQ(steps, 400);
  for (const double time : field_of<T>(sim, "own_1"))
    EXPECT_NEAR(time, sim.event_time(), 1e-5 * sim.event_time());
  const auto pressure = field_of<double>(sim, "pressure"), stress = field_of<T>(sim, "own_2");
  for (std::size_t i = 0; i < stress.size(); ++i)
    EXPECT_NEAR(pressure[i], -stress[i], 0.5 + 1e-3 * std::abs(stress[i]));
  EXPECT_GT(*std::max_element(pressure.begin(), pressure.end()), 50);
}

TEST(ConstitutiveLaw, ItsOwnNumbersFollowTheirParticlesAndChangeOnlyInSteps) {
  expect_counted_steps<float>(Precision::float32);
  expect_counted_steps<double>(Precision::float64);
}

/// The fields of the stress are those that the law returned, not those of the snow's moduli.
template <int D>
void expect_own_stress(const scene::Scene& scene, int steps) {
  const auto law = reinterpret_cast<void*>(&soft<D>);
  Simulation sim(scene, ".", with(law, D * (D + 1) / 2));
  sim.begin_event();
  sim.step(steps);
  std::vector<std::vector<double>> stress;
  for (int k = 0; k < D * (D + 1) / 2; ++k)
    stress.push_back(field_of<double>(sim, "own_" + std::to_string(k)));
  const auto pressure = field_of<double>(sim, "pressure");
  const auto deviatoric = field_of<double>(sim, "deviatoric_stress");
  double largest = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    double mean = 0, squares = 0;
    for (int k = 0; k < D; ++k) mean += stress[k][i] / D;
    for (int k = 0; k < D; ++k) squares += (stress[k][i] - mean) * (stress[k][i] - mean);
    for (int k = D; k < D * (D + 1) / 2; ++k) squares += 2 * stress[k][i] * stress[k][i];
    const double mises = std::sqrt(1.5 * squares);
    EXPECT_NEAR(pressure[i], -mean, 1e-6 * (1 + mises)) << i;
    EXPECT_NEAR(deviatoric[i], mises, 1e-6 * (1 + mises)) << i;
    largest = std::max(largest, mises);
  }
  EXPECT_GT(largest, 50);
}

TEST(ConstitutiveLaw, StressesInResultsAreItsOwnAlsoInShear) {
  expect_own_stress<2>(one_event(), 400);
  expect_own_stress<3>(falling_box(3, Precision::float64), 200);
}

/// Sorting moves the plastic strain apart from the law's numbers, so the two must agree afterwards.
TEST(ConstitutiveLaw, ReturnsEachParticleOnceAStepAndItsStateStays) {
  scene::Scene scene = falling_box(2, Precision::float64);
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0;
  returned = asked_again = 0;
  Simulation sim(scene, ".", with(reinterpret_cast<void*>(&flowing), 2));
  sim.begin_event();
  const double before = field_of<double>(sim, "volumetric_plastic_strain").at(0);
  sim.step(400);  // until sorting has rearranged the particles
  const auto pressure = field_of<double>(sim, "pressure");
  EXPECT_EQ(returned, 400 * std::int64_t(pressure.size()));
  EXPECT_GT(asked_again, 0);  // for the grid after sorting, and for the fields
  const auto flowed = field_of<double>(sim, "own_0"), left = field_of<double>(sim, "own_1");
  const auto plastic = field_of<double>(sim, "volumetric_plastic_strain");
  const auto shear = field_of<double>(sim, "be_minus_identity_xz");
  const auto xx = field_of<double>(sim, "be_minus_identity_xx");
  const auto zz = field_of<double>(sim, "be_minus_identity_zz");
  double largest = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    EXPECT_NEAR(plastic[i] - before, flowed[i], 1e-14) << i;
    EXPECT_NEAR(shear[i], 0, 1e-15) << i;
    EXPECT_NEAR(xx[i], std::expm1(left[i]), 1e-12) << i;  // b = exp(2 e), e half of the volumetric
    EXPECT_NEAR(zz[i], xx[i], 1e-15) << i;
    largest = std::max(largest, std::abs(left[i]));
  }
  EXPECT_GT(largest, 1e-6);
}

TEST(ConstitutiveLaw, KnowsTheSnowOfEachParticle) {
  scene::Scene scene = one_event();
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "sphere";
  body.shape.center = {0.4, 0, 0.3};
  body.shape.radius = 0.03;
  body.snow.emplace().density = 300;
  Simulation sim(scene, ".", with(reinterpret_cast<void*>(&count_steps<double>), 4));
  sim.begin_event();
  sim.step(100);
  const auto passed = field_of<double>(sim, "own_3");
  const auto ids = field_of<std::uint8_t>(sim, "material_id");
  EXPECT_EQ(passed, ids);
  EXPECT_EQ(*std::max_element(ids.begin(), ids.end()), 1);
}

TEST(ConstitutiveLaw, WrongOnesAreRefused) {
  const auto law = reinterpret_cast<void*>(&liquid);
  scene::Scene scene = one_event();
  UserLaws both = with(law);
  both.material = law;
  EXPECT_THROW(Simulation(scene, ".", both), InputError);
  EXPECT_THROW(Simulation(scene, ".", with(law, methods::max_own_numbers + 1)), InputError);
  EXPECT_THROW(Simulation(scene, ".", with(law, -1)), InputError);
  scene.output.energy = true;
  EXPECT_THROW(Simulation(scene, ".", with(law)), InputError);
  scene = one_event();
  scene.snow.model = material::SnowModel::elastic;
  EXPECT_THROW(Simulation(scene, ".", with(law)), InputError);
}

using ConstitutiveLawFiles = io::TemporaryFolder;

TEST_F(ConstitutiveLawFiles, ACheckpointHoldsItsNumbersAndResumesToTheSameBits) {
  const auto laws = with(reinterpret_cast<void*>(&count_steps<double>), 4);
  Simulation sim(one_event(), ".", laws);
  sim.begin_event();
  sim.step(64);
  sim.save(path("checkpoint.bin"));
  const auto loaded = Simulation::load(path("checkpoint.bin"), {}, laws);
  loaded->step(100);
  sim.step(100);
  EXPECT_TRUE(loaded->method().state().positions == sim.method().state().positions);
  for (const char* name : {"own_0", "own_1", "own_2"})
    EXPECT_EQ(field_of<double>(*loaded, name), field_of<double>(sim, name));
  UserLaws fewer = laws;
  fewer.own_numbers = 0;
  EXPECT_THROW(Simulation::load(path("checkpoint.bin"), {}, fewer), InputError);
  fewer.own_numbers = 3;
  EXPECT_THROW(Simulation::load(path("checkpoint.bin"), {}, fewer), InputError);
}

}  // namespace
}  // namespace snowshed::run
