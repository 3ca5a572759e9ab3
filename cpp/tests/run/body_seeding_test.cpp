#include "snowshed/run/body_seeding.hpp"

#include <gtest/gtest.h>

#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

TEST(BodySeeding, EverySlabHasNewPositionsAndTheSameMass) {
  const scene::Scene scene = scene::resolve(small_scene());
  const PanelRegion panel(scene);
  const SeededSnow first = seed_event(scene, {}, panel, 1, 0.0);
  const SeededSnow second = seed_event(scene, {}, panel, 2, 0.0);
  const methods::ParticleBatch &first_slab = first.batches.at(0),
                               &second_slab = second.batches.at(0);
  EXPECT_FALSE(first_slab.positions == second_slab.positions);
  EXPECT_EQ(second_slab.event, 2);
  for (const methods::ParticleBatch* slab : {&first_slab, &second_slab})
    EXPECT_NEAR(slab->mass * double(slab->positions.size()), 210 * 0.1 * 0.03, 1e-9);
}

/// Twice the volume of a solid in the same place, as the thesis gives a stack n slabs (A.3.5).
TEST(BodySeeding, AGivenVolumeGivesTheMassAndIsNoted) {
  scene::Scene scene = small_scene();
  scene.slab.reset();
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "box";
  body.shape.center = {0.5, 0, 0.1};
  body.shape.size = {0.2, 1, 0.1};
  const auto seeded = [&](double volume) {
    scene.bodies[0].volume = volume;
    const scene::Scene resolved = scene::resolve(scene);
    return seed_event(resolved, {}, PanelRegion(resolved), 1, 0.0);
  };
  const SeededSnow solid = seeded(0), twice = seeded(2 * 0.2 * 0.1);
  EXPECT_TRUE(solid.notes.empty());
  ASSERT_EQ(twice.notes.size(), 1u);
  EXPECT_EQ(twice.notes[0].rfind("/bodies/0/shape: its snow has the given volume of 0.04 m2", 0),
            0u);
  EXPECT_TRUE(solid.batches[0].positions == twice.batches[0].positions);
  EXPECT_NEAR(solid.mass, 210 * 0.02, 1e-9);
  EXPECT_NEAR(twice.mass, 210 * 0.04, 1e-12);
}

TEST(BodySeeding, AMethodThatFillsBodiesItselfTakesNoVolume) {
  scene::Scene scene;
  scene.dimension = 2;
  scene.numerics = methods::mps::Settings{};
  scene.ground.emplace();
  scene::BodySpec& body = scene.bodies.emplace_back();
  body.shape.type = "sphere";
  body.shape.center = {0, 0, 0.5};
  body.shape.radius = 0.3;
  EXPECT_NO_THROW(scene::validate(scene));
  scene.bodies[0].volume = 1;
  EXPECT_THROW(scene::validate(scene), InputError);
}

}  // namespace
}  // namespace snowshed::run
