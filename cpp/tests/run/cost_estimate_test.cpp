#include "snowshed/run/cost_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/run/motion_estimate.hpp"
#include "snowshed/scene/presets.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

constexpr double g = 9.81;
const double sine = std::sin(radians(40)), cosine = std::cos(radians(40));

/// The first time step of a scene at rest, s.
double first_time_step(const scene::Scene& scene) { return estimate_cost(scene).time_step; }

/// Motion of the snow of a scene, and its cost.
struct Estimate : methods::CostEstimate, methods::SnowMotion {
  using methods::CostEstimate::event_time;
};
Estimate estimate(const scene::Scene& scene) {
  return {estimate_cost(scene), estimate_motion(scene::resolve(scene))};
}

TEST(CostEstimate, CountsTheParticlesOfTheLaboratorySlab) {
  // 0.245 x 0.142 x 0.02 m of 0.01 m voxels with 8 particles each
  const methods::CostEstimate result = estimate_cost(scene::preset_scene("lab-40"));
  ASSERT_EQ(result.particles.size(), 5u);
  EXPECT_EQ(result.particles[0], std::round(0.245 * 0.142 * 0.02 * 1e6 * 8));
  EXPECT_EQ(result.particles[0], 5566.0);
  EXPECT_EQ(result.total_particles, 5 * 5566.0);
}

TEST(CostEstimate, CountsTheParticlesOfThePlaneScene) {
  // 2 x 0.05 m of 0.01 m pixels with 6 particles each
  EXPECT_EQ(estimate_cost(scene::preset_scene("geometry")).particles[0], 6000.0);
}

TEST(CostEstimate, ParticlesFollowTheBodiesOfEachEvent) {
  scene::Scene scene = scene::preset_scene("geometry");
  scene.events.count = 2;
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.event = 2;
  body.shape.type = "box";
  body.shape.size = {0.1, 0, 0.1};
  EXPECT_EQ(estimate_cost(scene).particles, (std::vector<double>{6000, 6600}));
  EXPECT_EQ(estimate_cost(scene, {1234, 12}).total_particles, 1246.0);
}

TEST(CostEstimate, TimeStepOfTheCalibratedSnowMatchesItsFormula) {
  // E 1 MPa, nu 0.3: lambda = 576923, mu = 384615 Pa
  const scene::Scene lab = scene::preset_scene("lab-40");
  const double stiffness = 3 * 576923.0769 + 2 * 384615.3846;
  EXPECT_NEAR(first_time_step(lab), 0.9 * 0.01 * std::sqrt(2 * 210 / (6 * stiffness)), 1e-12);
  EXPECT_NEAR(first_time_step(lab), 4.762e-5, 1e-8);
  EXPECT_NEAR(first_time_step(scene::preset_scene("geometry")), 5.430e-5, 1e-8);
  scene::Scene fine = lab;
  fine.numerics.as<methods::mpm::Settings>().dx = 0.005;
  fine.numerics.as<methods::mpm::Settings>().courant_factor = 0.45;
  EXPECT_NEAR(first_time_step(fine), first_time_step(lab) / 4, 1e-15);
}

TEST(CostEstimate, TheRearOfTheSlabDeterminesTheTime) {
  scene::Scene scene = scene::preset_scene("lab-40");
  scene.panel->friction = 0.3;
  const double acceleration = g * (sine - 0.3 * cosine);
  const double slide = std::sqrt(2 * 0.245 / acceleration);
  const double down = acceleration * slide * sine;
  const double fall = (-down + std::sqrt(down * down + 2 * g * 0.33)) / g;
  const Estimate result = estimate(scene);
  EXPECT_TRUE(result.slides);
  EXPECT_NEAR(result.sliding_time, slide, 1e-12);
  EXPECT_NEAR(result.sliding_time, 0.3477, 1e-3);
  EXPECT_NEAR(result.fall_time, fall, 1e-12);
  const double impact = std::sqrt(std::pow(acceleration * slide, 2) + 2 * g * 0.33);
  EXPECT_NEAR(result.event_time, slide + fall + impact / g, 1e-12);
  const double distance = 0.245 + fall * (acceleration * slide + g * fall / 2);
  EXPECT_NEAR(result.distance, distance, 1e-12);
  const double steps_for_distance = 2 * distance / (0.01 * 0.9);  // 0.6 % more
  EXPECT_EQ(result.steps, 5 * std::ceil(result.event_time / result.time_step + steps_for_distance));
  EXPECT_EQ(result.scattering, 1.0);
}

TEST(CostEstimate, OlderSnowIsAwakePartOfTheTime) {
  scene::Scene scene = scene::preset_scene("lab-40");
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0.0;
  const Estimate awake = estimate(scene);
  const double steps = awake.steps / 5, slab = awake.particles[0];
  EXPECT_NEAR(awake.updates, steps * slab * (1 + 2 + 3 + 4 + 5), 1.0);
  scene.numerics.as<methods::mpm::Settings>().sleep_speed = 0.02;
  const Estimate asleep = estimate(scene);
  EXPECT_LT(asleep.first_landing, asleep.sliding_time + asleep.fall_time);
  const double share = 0.5 * (1 - asleep.first_landing / asleep.event_time);
  EXPECT_NEAR(asleep.updates, steps * slab * (5 + share * (1 + 2 + 3 + 4)), 1e-6 * awake.updates);
}

TEST(CostEstimate, HigherFallsTakeLongerToSettle) {
  scene::Scene scene = scene::preset_scene("geometry");
  const auto settling = [&scene] {
    const Estimate f = estimate(scene);
    return f.event_time - f.sliding_time - f.fall_time;
  };
  scene.panel->height = 2.0;
  const double high = settling();
  scene.panel->height = 0.5;
  EXPECT_GT(high, settling());
}

TEST(CostEstimate, ATiltedGroundLengthensTheFall) {
  scene::Scene scene = scene::preset_scene("geometry");
  scene.panel->friction = 0.0;
  const double level = estimate(scene).fall_time;
  scene.ground->tilt = 30.0;
  const Estimate result = estimate(scene);
  EXPECT_GT(result.fall_time, level);
  // Where it lands, height above the tilted ground is zero.
  const double speed = g * sine * result.sliding_time, t = result.fall_time;
  const double drop = speed * sine * t + g * t * t / 2;
  EXPECT_NEAR(2.0 + speed * cosine * t * std::tan(radians(30)) - drop, 0.0, 1e-10);
}

TEST(CostEstimate, EnoughFrictionHoldsTheSlab) {
  scene::Scene scene = scene::preset_scene("lab-40");
  scene.panel->friction = 0.84;  // tan 40 = 0.8391
  EXPECT_FALSE(estimate(scene).slides);
  EXPECT_EQ(estimate(scene).event_time, 0.25);
  scene.panel->friction = 0.838;
  EXPECT_TRUE(estimate(scene).slides);
  scene.panel->friction = 0.0;
  scene.panel->condition = methods::Condition::sticky;
  EXPECT_FALSE(estimate(scene).slides);
}

TEST(CostEstimate, BodiesFallFromTheirCenter) {
  scene::Scene scene;
  scene.ground.emplace();
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "sphere";
  body.shape.radius = 0.1;
  body.shape.center = {0, 0, 2};
  EXPECT_NEAR(estimate(scene).fall_time, std::sqrt(2 * 2 / g), 1e-12);
  body.velocity.z() = 3.0;  // thrown up first
  EXPECT_NEAR(estimate(scene).fall_time, (3 + std::sqrt(9 + 4 * g)) / g, 1e-12);
}

/// In 0.5 s at 1000 m/s2 without ground, a run took 19115 steps, and an update took sixteen times
/// the work of one in the slab.
TEST(CostEstimate, SnowThatNeverLandsScatters) {
  scene::Scene scene = scene::preset_scene("lab-50");
  scene.panel->friction = 0.3;
  scene.ground.reset();
  scene.gravity = 1000.0;
  scene.numerics.as<methods::mpm::Settings>().dx = 0.02;
  scene.events.count = 1;
  scene.events.max_time = 0.5;
  const Estimate result = estimate(scene);
  EXPECT_EQ(result.event_time, 0.5);
  EXPECT_NEAR(result.steps, 19115, 0.05 * 19115);
  EXPECT_EQ(result.scattering, 15.0);
  scene.ground.emplace();
  EXPECT_LT(estimate(scene).steps, 6000);
  EXPECT_EQ(estimate(scene).scattering, 1.0);
}

TEST(CostEstimate, NoEventOutlastsItsLimit) {
  scene::Scene scene = scene::preset_scene("geometry");
  scene.events.max_time = 0.6;
  EXPECT_EQ(estimate(scene).event_time, 0.6);
  scene.gravity = 0.0;
  EXPECT_EQ(estimate(scene).event_time, 0.25);
  scene.bodies.emplace_back().shape.type = "sphere";
  scene.bodies[0].shape.center.z() = 1.0;
  EXPECT_EQ(estimate(scene).event_time, 0.6);  // it never lands
}

TEST(CostEstimate, DoublesNeedTwiceTheMemory) {
  scene::Scene scene = scene::preset_scene("lab-40");
  const double single = estimate(scene).bytes;
  EXPECT_GT(single, 150.0 * 27830);
  EXPECT_LT(single, 300.0 * 27830);
  scene.numerics.as<methods::mpm::Settings>().precision = methods::mpm::Precision::float64;
  EXPECT_NEAR(estimate(scene).bytes, 2 * single, 1e-6 * single);
}

TEST(CostEstimate, AbsurdScenesAreEstimatedAndRefused) {
  scene::Scene scene = scene::preset_scene("lab-40");
  scene.numerics.as<methods::mpm::Settings>().dx = 1e-9;
  EXPECT_GT(estimate(scene).total_particles, 1e20);
  EXPECT_THROW(check_memory(estimate(scene).bytes), InputError);
  scene.numerics.as<methods::mpm::Settings>().dx = std::numeric_limits<double>::denorm_min();
  EXPECT_THROW(check_memory(estimate(scene).bytes), InputError);
}

TEST(CostEstimate, MemoryErrorsNameBothNumbers) {
  EXPECT_NO_THROW(check_memory(4e9, 4e9));
  EXPECT_NO_THROW(check_memory(1e6));
  EXPECT_THROW(check_memory(4.001e9, 4e9), InputError);
  try {
    check_memory(3.21e10, 1.6e10);
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("32.1 GB"), std::string::npos) << message;
    EXPECT_NE(message.find("16 GB"), std::string::npos) << message;
  }
}

TEST(CostEstimate, OverlappingObstaclesNeedMemoryAtEachNode) {
  scene::Scene scene = scene::preset_scene("lab-40");
  const double without = estimate(scene).bytes;
  scene::ObstacleSpec sphere;
  sphere.shape.type = "sphere";
  sphere.shape.radius = 0.2;
  scene.obstacles.assign(10000, sphere);
  const double together = estimate(scene).bytes;
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    scene.obstacles[i].shape.center.x() = double(i);
  const double separate = estimate(scene).bytes;
  EXPECT_GT(together, 100 * without);
  EXPECT_LT(separate, without + 2e7);
}

TEST(CostEstimate, ScatteredSnowNeedsMoreGridMemory) {
  scene::Scene scene = scene::preset_scene("lab-40");
  scene.slab.reset();
  scene.panel.reset();
  scene::BodySpec grain;
  grain.shape.type = "sphere";
  grain.shape.radius = 0.006;
  scene.bodies.assign(500, grain);
  const double scattered = estimate(scene).bytes;
  scene.bodies.resize(1);
  scene.bodies[0].shape.radius *= std::cbrt(500.0);
  EXPECT_GT(scattered, 2 * estimate(scene).bytes);
}

}  // namespace
}  // namespace snowshed::run
