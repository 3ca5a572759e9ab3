#include "snowshed/scene/effect_notes.hpp"

#include <gtest/gtest.h>

#include "scene/panel_scene.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/presets.hpp"

namespace snowshed::scene {
namespace {

std::vector<std::string> effect_notes_of(const Scene& scene) {
  std::vector<std::string> notes;
  add_notes_on_effects(scene, build_obstacles(scene, "", nullptr), notes);
  return notes;
}

Scene scene_with_ball(double x, double z) {
  Scene scene = panel_scene(40);
  scene.ground = Ground{};
  ObstacleSpec& ball = scene.obstacles.emplace_back();
  ball.shape.type = "sphere";
  ball.shape.center = {x, 0, z};
  ball.shape.radius = 0.1;
  return scene;
}

void expect_note(const Scene& scene, const std::string& text) {
  const auto notes = effect_notes_of(scene);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find(text), std::string::npos) << notes[0];
}

TEST(EffectNotes, ThePresetsHaveNoNotesOnEffects) {
  for (const std::string& name : scene_preset_names())
    EXPECT_TRUE(effect_notes_of(preset_scene(name)).empty()) << name;
}

TEST(EffectNotes, FrictionOfAStickyPartIsNotUsed) {
  Scene scene = panel_scene(40);
  scene.ground = Ground{};
  EXPECT_TRUE(effect_notes_of(scene).empty());
  scene.ground->friction = 0.5;
  expect_note(scene, "/ground/friction: 0.5 is not used");
  scene.ground->condition = methods::Condition::separate;
  EXPECT_TRUE(effect_notes_of(scene).empty());
}

TEST(EffectNotes, SlipHoldsNoSnowInMethodsWhoseWallsNeverPull) {
  Scene scene = panel_scene(40);
  scene.panel->condition = methods::Condition::slip;
  EXPECT_TRUE(effect_notes_of(scene).empty());
  scene.numerics = methods::mps::Settings{};
  expect_note(scene, "/panel/condition: \"slip\" acts as \"separate\"");
  scene.panel->condition = methods::Condition::separate;
  EXPECT_TRUE(effect_notes_of(scene).empty());
}

TEST(EffectNotes, SettingsWithoutEffectAreNotUsed) {
  Scene scene = panel_scene(40);
  auto& cells = scene.numerics.as<methods::mpm::Settings>();
  cells.contact_radius = 0.5;
  expect_note(scene, "/numerics/contact_radius: 0.5 is not used, because contact is \"kernel\"");
  cells.contact = methods::mpm::ContactRule::touch;
  EXPECT_TRUE(effect_notes_of(scene).empty());
  cells.sleep_speed = 0;
  EXPECT_TRUE(effect_notes_of(scene).empty());
  cells.sleep_time = 0.1;
  expect_note(scene, "/numerics/sleep_time: 0.1 is not used, because sleep_speed is 0");
}

TEST(EffectNotes, AFluidsSettingsWithoutEffectAreNotUsed) {
  Scene scene = panel_scene(40);
  methods::mps::Settings fluid;
  fluid.stress_growth = 1000;
  fluid.yield_strain = 0.001;
  scene.numerics = fluid;
  expect_note(scene, "/numerics/stress_growth: 1000 is not used");
  fluid.stress = methods::mps::Stress::published;
  scene.numerics = fluid;
  expect_note(scene, "/numerics/yield_strain: 0.001 is not used");
}

TEST(EffectNotes, SettingsOfPartsThatATerrainLacksAreNotUsed) {
  Scene scene;
  scene.terrain.emplace();
  methods::slide::Settings slide;
  slide.resistance = 100;
  slide.forest_max_speed = 50;
  slide.erosion_energy = 1;
  slide.max_strain = 0.3;
  scene.numerics = slide;
  EXPECT_EQ(effect_notes_of(scene).size(), 3u);
  scene.terrain->resistance.emplace_back();
  scene.terrain->entrainment.emplace_back();
  expect_note(scene, "/numerics/forest_max_speed: 50 is not used, because detrainment is 0");
  scene.numerics.as<methods::slide::Settings>().detrainment = 20;
  EXPECT_TRUE(effect_notes_of(scene).empty());
}

TEST(EffectNotes, IntervalsOfRecordsThatAreNotKeptAreNotUsed) {
  Scene scene = panel_scene(40);
  scene.output.force_interval = 0.1;
  expect_note(scene, "/output/force_interval: 0.1 s is not used");
  scene.output.forces = true;
  EXPECT_TRUE(effect_notes_of(scene).empty());
  scene.output.film = false;
  scene.output.film_interval = 0.2;
  expect_note(scene, "/output/film_interval: 0.2 s is not used");
}

TEST(EffectNotes, ObstaclesThatNoSnowMeetsAreNoted) {
  EXPECT_TRUE(effect_notes_of(scene_with_ball(1.5, 0.05)).empty());
  expect_note(scene_with_ball(1.5, -0.2), "/obstacles/0: it lies below the ground");
  expect_note(scene_with_ball(1500, 0.05), "/obstacles/0: it lies");
}

TEST(EffectNotes, AnObstacleThatMovesMayComeNear) {
  Scene scene = scene_with_ball(1500, 0.05);
  scene.obstacles[0].motion = geometry::MotionSpec{};
  EXPECT_TRUE(effect_notes_of(scene).empty());
}

TEST(EffectNotes, MotionsThatBeginAfterTheRunAreNoted) {
  Scene scene = scene_with_ball(1.5, 0.05);
  scene.events.count = 2;
  scene.events.max_time = 10;
  scene.obstacles[0].motion = geometry::MotionSpec{};
  scene.obstacles[0].motion->start = 19;
  EXPECT_TRUE(effect_notes_of(scene).empty());
  scene.obstacles[0].motion->start = 20;
  expect_note(scene, "/obstacles/0/motion/start: 20 s is after the end of the run");
}

}  // namespace
}  // namespace snowshed::scene
