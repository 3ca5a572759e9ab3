#include "snowshed/run/body_seeding.hpp"

#include <gtest/gtest.h>

#include "run/simulation_testing.hpp"
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

}  // namespace
}  // namespace snowshed::run
