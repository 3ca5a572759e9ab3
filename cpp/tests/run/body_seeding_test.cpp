#include "snowshed/run/body_seeding.hpp"

#include <gtest/gtest.h>

#include "run/simulation_testing.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

TEST(BodySeeding, EverySlabIsSeededAnewWithTheSameMass) {
  const Scene scene = resolve(small_scene());
  const PanelRegion panel(scene);
  const SeededSnow first = seed_event(scene, {}, panel, 1, 0.0);
  const SeededSnow second = seed_event(scene, {}, panel, 2, 0.0);
  const ParticleBatch &one = first.batches.at(0), &other = second.batches.at(0);
  EXPECT_FALSE(one.positions == other.positions);
  EXPECT_EQ(other.event, 2);
  for (const ParticleBatch* slab : {&one, &other})
    EXPECT_NEAR(slab->mass * double(slab->positions.size()), 210 * 0.1 * 0.03, 1e-9);
}

}  // namespace
}  // namespace snowshed
