// The presets have the values of the thesis's tables, and each can be run and stored.
#include "snowshed/scene/presets.hpp"

#include <gtest/gtest.h>

#include "scene/scene_equal.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::scene {
namespace {

void expect_snow(const material::Snow& snow, double slope, double pressure, double cohesion) {
  EXPECT_EQ(snow.model, material::SnowModel::cam_clay);
  EXPECT_EQ(snow.density, 210.0);
  EXPECT_EQ(snow.youngs_modulus, 1e6);
  EXPECT_EQ(snow.poissons_ratio, 0.3);
  EXPECT_EQ(snow.hardening_factor, 0.1);
  EXPECT_EQ(snow.critical_state_slope, slope);
  EXPECT_EQ(snow.preconsolidation_pressure, pressure);
  EXPECT_EQ(snow.cohesion, cohesion);
}

void expect_conditions(const Scene& scene) {
  EXPECT_EQ(scene.panel->condition, methods::Condition::separate);
  EXPECT_EQ(scene.ground->condition, methods::Condition::sticky);
  EXPECT_EQ(scene.ground->tilt, 0.0);
  EXPECT_EQ(scene.numerics.as<methods::mpm::Settings>().dx, 0.01);
  EXPECT_EQ(scene.gravity, 9.81);
}

TEST(Presets, SnowMatchesTables321And431) {
  expect_snow(preset_snow("calibrated"), 0.5, 7e3, 0.2);  // Table 4.3.1
  expect_snow(preset_snow("reference"), 0.5, 5e3, 0.1);   // Table 3.2.1
}

TEST(Presets, LaboratoryMatchesTables231And411) {
  for (const double tilt : {40.0, 50.0}) {
    const Scene scene = preset_scene(tilt == 40.0 ? "lab-40" : "lab-50");
    EXPECT_EQ(scene.dimension, 3);
    EXPECT_EQ(scene.panel->height, 0.33);
    EXPECT_EQ(scene.panel->length, 0.245);
    EXPECT_EQ(scene.panel->width, 0.213);
    EXPECT_EQ(scene.panel->tilt, tilt);
    EXPECT_TRUE(*resolve(scene).slab == (Slab{0.02, 0.245, 0.142}));
    EXPECT_EQ(scene.events.count, 5);
    EXPECT_TRUE(scene.snow == preset_snow("calibrated"));
    expect_conditions(scene);
  }
}

TEST(Presets, SensitivityMatchesTable321) {
  const Scene scene = preset_scene("sensitivity");
  EXPECT_EQ(scene.dimension, 3);
  EXPECT_EQ(scene.panel->height, 0.5);
  EXPECT_EQ(scene.panel->length, 0.245);
  EXPECT_EQ(scene.panel->width, 0.213);
  EXPECT_EQ(scene.panel->tilt, 40.0);
  EXPECT_TRUE(*resolve(scene).slab == (Slab{0.02, 0.245, 0.142}));
  EXPECT_EQ(scene.events.count, 3);
  EXPECT_TRUE(scene.snow == preset_snow("reference"));
  expect_conditions(scene);
}

TEST(Presets, GeometryMatchesTable511) {
  const Scene scene = preset_scene("geometry");
  EXPECT_EQ(scene.dimension, 2);
  EXPECT_EQ(scene.panel->height, 2.0);
  EXPECT_EQ(scene.panel->length, 2.0);
  EXPECT_EQ(scene.panel->tilt, 40.0);
  EXPECT_EQ(scene.slab->thickness, 0.05);
  EXPECT_EQ(resolve(scene).slab->length, 2.0);
  EXPECT_EQ(scene.events.count, 5);
  EXPECT_TRUE(scene.snow == preset_snow("calibrated"));
  expect_conditions(scene);
}

TEST(Presets, SlabsFollowTheLengthOfThePanel) {
  for (const auto& name : scene_preset_names()) {
    Scene scene = preset_scene(name);
    for (const double length : {0.2, 4.0}) {
      scene.panel->length = length;
      EXPECT_EQ(resolve(scene).slab->length, length) << name;
    }
  }
}

TEST(Presets, AllAreListedValidAndStorable) {
  EXPECT_EQ(snow_preset_names(), (std::vector<std::string>{"calibrated", "reference"}));
  EXPECT_EQ(scene_preset_names(),
            (std::vector<std::string>{"lab-40", "lab-50", "sensitivity", "geometry"}));
  for (const auto& name : scene_preset_names()) {
    const Scene scene = preset_scene(name);
    EXPECT_NO_THROW(validate(scene)) << name;
    EXPECT_TRUE(parse_scene(write_scene(scene)) == scene) << name;
  }
}

TEST(Presets, UnknownNamesGetASuggestion) {
  try {
    preset_scene("lab40");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "preset: \"lab40\" is none of \"lab-40\", \"lab-50\", \"sensitivity\", "
                 "\"geometry\"; did you mean \"lab-40\"?");
  }
  EXPECT_THROW(preset_snow("powder"), InputError);
}

}  // namespace
}  // namespace snowshed::scene
