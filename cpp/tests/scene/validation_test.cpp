// Rules between several fields: each is broken by one change to a valid scene.
#include "snowshed/scene/validation.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "snowshed/core/errors.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::scene {
namespace {

Scene good_scene() {
  return parse_scene(R"({"snowshed": 2,
    "panel": {"height": 1, "length": 2, "width": 3, "tilt": 45}, "slab": {"thickness": 0.1},
    "ground": {},
    "obstacles": [
      {"name": "post", "shape": {"type": "capsule", "from": [1, 0, 0], "to": [1, 0, 1], "radius": 1},
       "motion": {"start": 1, "end": 2}},
      {"name": "shed", "shape": {"type": "plate", "length": 1, "width": 1, "thickness": 1}},
      {"shape": {"type": "sphere", "radius": 1}}, {"shape": {"type": "sphere", "radius": 1}}],
    "bodies": [{"shape": {"type": "box", "center": [0, 0, 1], "size": [2, 4, 2]}}],
    "domain": {"min": [-1, -2, 0], "max": [1, 2, 3]}})");
}

struct Violation {
  const char* where;
  const char* part_of_message;
  std::function<void(Scene&)> change;
};

void PrintTo(const Violation& rule, std::ostream* out) { *out << rule.where; }

class SceneRules : public testing::TestWithParam<Violation> {};

TEST(SceneRulesBase, TheUnchangedSceneIsValid) { EXPECT_NO_THROW(validate(good_scene())); }

TEST_P(SceneRules, AreEnforced) {
  Scene scene = good_scene();
  GetParam().change(scene);
  try {
    validate(scene);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), GetParam().where) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().part_of_message), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneRules,
    testing::ValuesIn(std::vector<Violation>{
        {"/slab", "there is no /panel", [](Scene& s) { s.panel.reset(); }},
        {"/slab/length", "2.5 m is longer than the panel (/panel/length = 2 m)",
         [](Scene& s) { s.slab->length = 2.5; }},
        {"/slab/width", "3.5 m is wider than the panel (/panel/width = 3 m)",
         [](Scene& s) { s.slab->width = 3.5; }},
        {"/slab/thickness", "missing: a thickness, or /slab/layers, is required",
         [](Scene& s) { s.slab->thickness = 0; }},
        {"/slab/thickness", "0.1 m and /slab/layers are both given",
         [](Scene& s) { s.slab->layers.emplace_back().thickness = 0.1; }},
        {"/slab/layers/1/event", "2 is beyond the last event (/events/count = 1)",
         [](Scene& s) {
           s.slab->thickness = 0;
           s.slab->layers = {{0.1, {}, 1}, {0.1, {}, 2}};
         }},
        {"/slab", "from z = 1 to 2.55563 m, beyond the domain (0 to 2.5 m)",
         [](Scene& s) {
           s.slab->thickness = 0;
           s.slab->layers = {{0.1, {}, 0}, {0.1, {}, 1}, {0.1, {}, 2}};
           s.events.count = 2;
           s.domain->max.z() = 2.5;
         }},
        {"/", "257 different snows in slab and bodies; at most 256 are allowed",
         [](Scene& s) {
           s.slab->thickness = 0;
           s.slab->layers.resize(600, {1e-4, s.snow, 0});
           for (std::size_t i = 0; i < 256; ++i) s.slab->layers[2 * i].snow->density += 1.0 + i;
         }},
        {"/slab", "from z = 1 to 2.48492 m, beyond the domain (0 to 2.4 m)",
         [](Scene& s) { s.domain->max.z() = 2.4; }},
        {"/bodies/0/shape", "beyond the domain (-1.9 to 2 m)",
         [](Scene& s) { s.domain->min.y() = -1.9; }},
        {"/bodies/0/shape", "unbounded", [](Scene& s) { s.bodies[0].shape.type = "plane"; }},
        {"/bodies/0/event", "2 is beyond the last event (/events/count = 1)",
         [](Scene& s) { s.bodies[0].event = 2; }},
        {"/domain/max", "y = -2 must be above /domain/min, -2",
         [](Scene& s) { s.domain->max.y() = -2; }},
        {"/panel/tilt", "below the ground",
         [](Scene& s) {
           s.ground->tilt = 59;
           s.panel->tilt = 5;
         }},
        {"/obstacles/0/motion/end", "0.5 s is before the start (/obstacles/0/motion/start = 1 s)",
         [](Scene& s) { s.obstacles[0].motion->end = 0.5; }},
        {"/obstacles/0/shape/to", "must differ from /obstacles/0/shape/from",
         [](Scene& s) { s.obstacles[0].shape.to = s.obstacles[0].shape.from; }},
        {"/obstacles/1/shape/normal", "along y",
         [](Scene& s) { s.obstacles[1].shape.normal = {0, -2, 0}; }},
        {"/obstacles/1/name", "\"post\" is already",
         [](Scene& s) { s.obstacles[1].name = "post"; }},
        {"/obstacles/1/name", "\"panel\" is already",
         [](Scene& s) { s.obstacles[1].name = "panel"; }},
        {"/obstacles/0/name", "\"ground\" is already",
         [](Scene& s) { s.obstacles[0].name = "ground"; }},
        {"/seeding/particles_per_voxel", "5 is too few in 3D: give at least 6",
         [](Scene& s) { s.seeding.particles_per_voxel = 5; }},
        {"/events/rest_time", "longer than an event", [](Scene& s) { s.events.rest_time = 11; }},
        {"/", "give /slab or /bodies", [](Scene& s) {
           s.slab.reset();
           s.bodies.clear();
         }}}));

TEST(SceneRulesBase, AllowedValuesAreAccepted) {
  Scene scene = good_scene();
  scene.seeding.particles_per_voxel = 6;
  EXPECT_NO_THROW(validate(scene));
  scene.seeding.particles_per_voxel = 0.5;
  scene.seeding.allow_sparse = true;
  EXPECT_NO_THROW(validate(scene));
  scene.bodies[0].event = 0;
  scene.slab->length = scene.panel->length;
  scene.slab->width = scene.panel->width;
  scene.snow.model = material::SnowModel::elastic;
  EXPECT_NO_THROW(validate(scene));
}

TEST(SceneRulesBase, PlaneScenesNeedNoWidth) {
  Scene scene = good_scene();
  scene.dimension = 2;
  scene.panel->width = 0;
  scene.slab->width = 7;
  scene.domain->min.y() = scene.domain->max.y() = 0;
  scene.seeding.particles_per_voxel = 4;
  EXPECT_NO_THROW(validate(scene));
  scene.seeding.particles_per_voxel = 3.9;
  EXPECT_THROW(validate(scene), InputError);
}

TEST(SceneParts, AreRefusedByMethodsThatLackThem) {
  const Scene scene = good_scene();
  const auto refused = [&](const methods::Parts& parts) {
    try {
      check_parts(scene, {"slide", "", parts});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string end = R"(: the method "slide" takes no such part; methods that do: mpm, mps)";
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::slab, methods::Part::ground,
                     methods::Part::obstacles, methods::Part::bodies, methods::Part::domain}),
            "nothing");
  EXPECT_EQ(refused({methods::Part::slab, methods::Part::ground, methods::Part::obstacles,
                     methods::Part::bodies, methods::Part::domain}),
            "/panel" + end);
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::ground, methods::Part::obstacles,
                     methods::Part::bodies, methods::Part::domain}),
            "/slab" + end);
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::slab, methods::Part::obstacles,
                     methods::Part::bodies, methods::Part::domain}),
            "/ground" + end);
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::slab, methods::Part::ground,
                     methods::Part::bodies, methods::Part::domain}),
            "/obstacles" + end);
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::slab, methods::Part::ground,
                     methods::Part::obstacles, methods::Part::domain}),
            "/bodies" + end);
  EXPECT_EQ(refused({methods::Part::panel, methods::Part::slab, methods::Part::ground,
                     methods::Part::obstacles, methods::Part::bodies}),
            "/domain" + end);
}

}  // namespace
}  // namespace snowshed::scene
