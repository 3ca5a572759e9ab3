#include "snowshed/methods/user_laws.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/material/cam_clay.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed::run {
namespace {

using methods::UserLaws;

/// No law at all: the snow stays elastic.
void stay_elastic(std::int64_t, double*, double*, double*, const std::uint8_t*, double) {}

/// Snow without shear strength.
void lose_shear(std::int64_t count, float*, float* q, float*, const std::uint8_t*, double) {
  for (std::int64_t i = 0; i < count; ++i) q[i] = 0;
}

std::atomic<int> calls{0};
void count_calls(std::int64_t count, float*, float*, float*, const std::uint8_t* snow, double dt) {
  calls += snow[0] == 0 && dt > 0 ? int(count) : 1000000;
}

double always(double, double) { return 0.2; }
double grows_with_speed(double speed, double normal_stress) {
  return normal_stress >= 0 ? 4.0 * speed : 0.0;
}

void upwards(std::int64_t count, const double*, const double*, const double*, double, double*,
             double*, double* az) {
  for (std::int64_t i = 0; i < count; ++i) az[i] = 9.81;
}
void swirl(std::int64_t count, const double* x, const double*, const double* z, double, double* ax,
           double*, double* az) {
  for (std::int64_t i = 0; i < count; ++i) ax[i] = -z[i], az[i] = x[i];
}

/// The plate swings along x.
void swing(double time, double* pose) {
  pose[0] = 0.01 * std::sin(20 * time);
  pose[6] = 0.2 * std::cos(20 * time);
}

UserLaws named(const std::string& name) {
  UserLaws laws;
  laws.name = name;
  return laws;
}

scene::Scene slide_of_own_laws() {
  scene::Scene scene = small_scene();
  scene.events.count = 1;
  scene.output.energy = false;
  return scene;
}

methods::ParticleState state_after(const scene::Scene& scene, const UserLaws& laws, int steps) {
  Simulation sim(scene, ".", laws);
  sim.begin_event();
  sim.step(steps);
  return sim.method().state();
}

TEST(UserLaws, ALawThatDoesNothingLeavesElasticSnow) {
  scene::Scene scene = slide_of_own_laws();
  scene.numerics.as<methods::mpm::Settings>().precision = methods::mpm::Precision::float64;
  UserLaws laws = named("elastic");
  laws.material = reinterpret_cast<void*>(&stay_elastic);
  const auto with_law = state_after(scene, laws, 600);
  scene.snow.model = material::SnowModel::elastic;
  const auto built_in = state_after(scene, {}, 600);
  // The kernels of elastic snow round differently where the processor fuses operations.
  for (std::size_t i = 0; i < built_in.positions.size(); ++i)
    EXPECT_LT((with_law.positions[i] - built_in.positions[i]).norm(), 1e-12);
}

/// The law of the snow itself, with packs as the kernels of this build.
template <class T>
material::CamClay<T> cam_clay() {
  const material::Snow snow;
  return material::CamClay<T>::from(snow.youngs_modulus, snow.poissons_ratio,
                                    snow.critical_state_slope, snow.cohesion, snow.hardening_factor,
                                    2);
}
template <class T>
void unchanged_snow(std::int64_t count, T* p, T* q, T* plastic, const std::uint8_t*, double) {
  static const material::CamClay<T> law = cam_clay<T>();
  using V = SimdPack<T>;
  for (std::int64_t at = 0; at < count; at += simd_width<T>) {
    const int n = int(std::min<std::int64_t>(count - at, simd_width<T>));
    material::PQ<V> stress{load(p + at, n), load(q + at, n)};
    V state = load(plastic + at, n);
    law.return_map(stress, state);
    store(p + at, stress.p, n);
    store(q + at, stress.q, n);
    store(plastic + at, state, n);
  }
}

TEST(UserLaws, TheLawOfTheSnowGivesTheSameBits) {
  if (std::string(kernel_variant_name()) != "baseline")
    GTEST_SKIP() << "needs the kernels of this file: SNOWSHED_KERNELS=baseline";
  for (const auto precision :
       {methods::mpm::Precision::float32, methods::mpm::Precision::float64}) {
    const scene::Scene scene = falling_box(2, precision);
    UserLaws laws = named("cam-clay");
    laws.material = precision == methods::mpm::Precision::float32
                        ? reinterpret_cast<void*>(&unchanged_snow<float>)
                        : reinterpret_cast<void*>(&unchanged_snow<double>);
    Simulation mine(scene, ".", laws), own(scene);
    for (Simulation* sim : {&mine, &own}) {
      sim->begin_event();
      sim->step(1500);
    }
    const auto a = mine.method().state(), b = own.method().state();
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_TRUE(a.velocities == b.velocities);
    EXPECT_TRUE(a.densities == b.densities);
    expect_yielded(mine);
  }
}

TEST(UserLaws, TheLawOfTheSnowIsReplaced) {
  const scene::Scene scene = slide_of_own_laws();
  UserLaws laws = named("fluid");
  laws.material = reinterpret_cast<void*>(&lose_shear);
  EXPECT_FALSE(state_after(scene, laws, 600).positions == state_after(scene, {}, 600).positions);
}

TEST(UserLaws, EveryParticleIsPassedOnceAStep) {
  calls = 0;
  UserLaws laws = named("counter");
  laws.material = reinterpret_cast<void*>(&count_calls);
  scene::Scene scene = slide_of_own_laws();
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0;
  const auto state = state_after(scene, laws, 100);
  EXPECT_EQ(calls, 100 * int(state.positions.size()));
}

TEST(UserLaws, AConstantCoefficientGivesTheBitsOfTheScene) {
  UserLaws laws = named("friction");
  laws.friction["panel"] = &always;
  const scene::Scene scene = slide_of_own_laws();
  ASSERT_EQ(scene.panel->friction, 0.2);
  EXPECT_TRUE(state_after(scene, laws, 600).positions == state_after(scene, {}, 600).positions);
}

TEST(UserLaws, FrictionThatGrowsWithTheSpeedLimitsIt) {
  UserLaws laws = named("friction");
  laws.friction["panel"] = &grows_with_speed;
  scene::Scene scene = slide_of_own_laws();
  scene.panel->length = 0.5;
  scene.slab->length = 0.1;
  Simulation sim(scene, ".", laws);
  sim.begin_event();
  while (sim.event_time() < 0.3) sim.step();
  // tan 50 degrees = 4 v
  EXPECT_NEAR(sim.method().motion(0.01).rms_speed, std::tan(50 * M_PI / 180) / 4, 0.06);
}

TEST(UserLaws, ABodyForceAgainstGravityKeepsSnowAtRest) {
  scene::Scene scene = slide_of_own_laws();
  scene.panel->tilt = 0;
  UserLaws laws = named("floating");
  laws.body_force = &upwards;
  Simulation sim(scene, ".", laws);
  sim.begin_event();
  sim.step(300);
  EXPECT_LT(sim.method().motion(1).rms_speed, 1e-6);
}

TEST(UserLaws, ABodyForceAcceleratesFreeSnowAsItSays) {
  scene::Scene scene;
  scene.dimension = 2;
  scene.gravity = 0;
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "sphere";
  body.shape.center = {0.5, 0, 0.25};
  body.shape.radius = 0.05;
  scene.numerics.as<methods::mpm::Settings>().dx = 0.01;
  UserLaws laws = named("swirl");
  laws.body_force = &swirl;
  Simulation sim(scene, ".", laws);
  sim.begin_event();
  while (sim.event_time() < 0.01) sim.step();
  const auto state = sim.method().state();
  double x = 0, z = 0;
  for (const Vec3& v : state.velocities) x += v.x(), z += v.z();
  const double n = double(state.velocities.size()), t = sim.event_time();
  EXPECT_NEAR(x / n, -0.25 * t, 0.002 * t);
  EXPECT_NEAR(z / n, 0.5 * t, 0.004 * t);
}

TEST(UserLaws, AnObstacleFollowsItsFunction) {
  scene::Scene scene = slide_of_own_laws();
  scene.panel->tilt = 0;
  scene.panel->condition = methods::Condition::sticky;
  UserLaws laws = named("swing");
  laws.motion["panel"] = &swing;
  Simulation sim(scene, ".", laws);
  sim.begin_event();
  while (sim.event_time() < 0.05) sim.step();
  const auto state = sim.method().state();
  double lowest = 1, speed = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i)
    if (state.positions[i].z() < lowest)
      lowest = state.positions[i].z(), speed = state.velocities[i].x();
  EXPECT_NEAR(speed, 0.2 * std::cos(20 * sim.event_time()), 0.02);
}

TEST(UserLaws, WrongLawsAreRefused) {
  UserLaws laws = named("friction");
  laws.friction["pannel"] = &always;
  EXPECT_THROW(Simulation(slide_of_own_laws(), ".", laws), InputError);
  laws = named("force");
  laws.body_force = &upwards;
  scene::Scene scene = slide_of_own_laws();
  scene.output.energy = true;
  EXPECT_THROW(Simulation(scene, ".", laws), InputError);
}

using UserLawsFiles = io::TemporaryFolder;

TEST_F(UserLawsFiles, ACheckpointNeedsTheSameLawsAgain) {
  UserLaws laws = named("friction");
  laws.friction["panel"] = &always;
  Simulation sim(slide_of_own_laws(), ".", laws);
  sim.begin_event();
  sim.save(path("checkpoint.bin"));
  EXPECT_THROW(Simulation::load(path("checkpoint.bin")), InputError);
  EXPECT_THROW(Simulation::load(path("checkpoint.bin"), {}, named("other")), InputError);
  const auto loaded = Simulation::load(path("checkpoint.bin"), {}, laws);
  loaded->step(100);
  sim.step(100);
  EXPECT_TRUE(loaded->method().state().positions == sim.method().state().positions);
}

}  // namespace
}  // namespace snowshed::run
