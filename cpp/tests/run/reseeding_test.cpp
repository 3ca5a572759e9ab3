#include "snowshed/run/reseeding.hpp"

#include <gtest/gtest.h>

#include "run/simulation_testing.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

/// A heap of one snow, and a hidden particle of another snow at the position of a particle of the
/// heap. No new particle takes the snow of the hidden one.
methods::ParticleState heap_with_a_hidden_grain() {
  methods::ParticleState heap;
  heap.positions = methods::mpm::filled_box(2, Vec3(1, 0, 0), Vec3(1.1, 0, 0.1), 0.005).positions;
  heap.material_ids.assign(heap.positions.size(), 0);
  heap.positions.push_back(heap.positions.front());
  heap.material_ids.push_back(1);
  heap.masses.assign(heap.positions.size(), 0.005);
  heap.events.assign(heap.positions.size(), 1);
  return heap;
}

TEST(Reseeding, GivesTheMassOfASnowWithoutParticlesToTheOthers) {
  scene::Scene scene = small_scene();
  material::Snow light;
  light.density = 120;
  scene.slab->thickness = 0;
  scene.slab->layers = {{0.01, light, 0}, {0.02, {}, 0}};
  scene = scene::resolve(scene);
  const methods::ParticleState heap = heap_with_a_hidden_grain();
  const Reseeding reseeding = reseed_stack(scene, PanelRegion(scene), heap, 1, 0.03);
  double mass = 0;
  for (const methods::ParticleBatch& batch : reseeding.batches) {
    EXPECT_EQ(batch.material_id, 0);
    mass += batch.mass * double(batch.positions.size());
  }
  EXPECT_NEAR(mass, 0.005 * double(heap.masses.size()), 1e-12);
}

}  // namespace
}  // namespace snowshed::run
