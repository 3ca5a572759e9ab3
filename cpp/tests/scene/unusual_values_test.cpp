#include "snowshed/scene/unusual_values.hpp"

#include <gtest/gtest.h>

#include "scene/panel_scene.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/scene/presets.hpp"

namespace snowshed::scene {
namespace {

std::vector<std::string> notes_on_unusual(const Scene& scene) {
  std::vector<std::string> notes;
  add_notes_on_unusual_values(scene, notes);
  return notes;
}

TEST(UnusualValues, UsualScenesHaveNoNotes) {
  EXPECT_TRUE(notes_on_unusual(panel_scene(40)).empty());
  for (const std::string& name : scene_preset_names())
    EXPECT_TRUE(notes_on_unusual(preset_scene(name)).empty()) << name;
}

TEST(UnusualValues, ZeroStandsForNoneAndHasNoNote) {
  Scene scene = panel_scene(0);
  scene.panel->friction = scene.panel->thickness = scene.panel->height = scene.gravity = 0;
  EXPECT_TRUE(notes_on_unusual(scene).empty());
}

TEST(UnusualValues, TheNoteHasPathValueAndUsualRange) {
  Scene scene = panel_scene(40);
  scene.snow.preconsolidation_pressure = 7;
  const auto notes = notes_on_unusual(scene);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "/snow/preconsolidation_pressure: 7 Pa is unusual; most values are 50 to 1e+07 Pa, so "
            "check its unit");
}

TEST(UnusualValues, PanelsLongerThanRoofsAreNoted) {
  Scene scene = panel_scene(40);
  scene.panel->length = 40;
  EXPECT_TRUE(notes_on_unusual(scene).empty());
  scene.panel->length = 50;  // half a metre in centimetres
  EXPECT_EQ(notes_on_unusual(scene).size(), 1u);
}

TEST(UnusualValues, AnglesInRadiansAreNotedWithEitherSign) {
  EXPECT_EQ(notes_on_unusual(panel_scene(0.87)).size(), 1u);
  EXPECT_EQ(notes_on_unusual(panel_scene(40, -0.35)).size(), 1u);
}

TEST(UnusualValues, AFewOfManyAreShownAndTheRestIsCounted) {
  Scene scene = panel_scene(0.87);
  scene.snow.density = 0.3;
  scene.panel->height = 330;
  for (int i = 0; i < 9; ++i) {
    ObstacleSpec& obstacle = scene.obstacles.emplace_back();
    obstacle.shape.type = "sphere";
    obstacle.shape.radius = 1;
    obstacle.friction = 30;
  }
  const auto notes = notes_on_unusual(scene);
  ASSERT_EQ(notes.size(), 6u);
  EXPECT_EQ(notes.back(), "7 further values are unusual");
}

TEST(UnusualValues, SpeedsBeyondAFallAreNoted) {
  Scene scene = panel_scene(40);
  BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "sphere";
  body.shape.radius = 1;
  body.velocity = {0, 0, -90};
  EXPECT_TRUE(notes_on_unusual(scene).empty());
  body.velocity = {90, 0, -90};
  ASSERT_EQ(notes_on_unusual(scene).size(), 1u);
  EXPECT_EQ(notes_on_unusual(scene)[0],
            "/bodies/0/velocity: 127 m/s is unusual; most values are 0 to 100 m/s, so check its "
            "unit");
}

TEST(UnusualValues, ThickReleasesOfSlidesAreNoted) {
  Scene scene;
  scene.terrain.emplace().release.emplace_back().thickness = 3;
  EXPECT_TRUE(notes_on_unusual(scene).empty());
  scene.terrain->release[0].thickness = 5;
  ASSERT_EQ(notes_on_unusual(scene).size(), 1u);
  EXPECT_EQ(notes_on_unusual(scene)[0].find("/terrain/release/0/thickness: 5 m is unusual"), 0u);
}

TEST(UnusualValues, SettingsOfMethodsAreChecked) {
  Scene scene;
  methods::slide::Settings settings;
  settings.density = 0.2;
  scene.numerics = settings;
  ASSERT_EQ(notes_on_unusual(scene).size(), 1u);
  EXPECT_EQ(notes_on_unusual(scene)[0].find("/numerics/density"), 0u);
}

}  // namespace
}  // namespace snowshed::scene
