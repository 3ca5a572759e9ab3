// Rules of scenes with grains: each is broken by one change to a valid scene.
#include <gtest/gtest.h>

#include <functional>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/validation.hpp"

namespace snowshed::methods::grains {
namespace {

scene::Scene good_scene() {
  return scene::parse_scene(R"({"snowshed": 2, "method": "grains",
    "sample": {"file": "labels.npy", "voxel_size": 5e-5},
    "loading": [{"kind": "compress", "strain": 0.4}, {"kind": "unload", "stress": 100},
                {"kind": "shear", "stress": 100}, {"kind": "penetrate"}, {"kind": "hold"}],
    "cone": {"radius": 0.001}})");
}

Settings& settings(scene::Scene& scene) { return scene.numerics.as<Settings>(); }

struct Violation {
  const char* where;
  const char* part_of_message;
  std::function<void(scene::Scene&)> change;
};

void PrintTo(const Violation& rule, std::ostream* out) { *out << rule.part_of_message; }

class GrainsRules : public testing::TestWithParam<Violation> {};

TEST_P(GrainsRules, AreEnforced) {
  scene::Scene scene = good_scene();
  ASSERT_NO_THROW(scene::validate(scene));
  GetParam().change(scene);
  try {
    scene::validate(scene);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), GetParam().where) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().part_of_message), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GrainsRules,
    testing::ValuesIn(std::vector<Violation>{
        {"/", "grains need a /sample", [](scene::Scene& s) { s.sample.reset(); }},
        {"/sample/file", "is not the name of a file", [](scene::Scene& s) { s.sample->file = ""; }},
        {"/sample/voxel_size", "0 is outside", [](scene::Scene& s) { s.sample->voxel_size = 0; }},
        {"/loading", "at least one stage", [](scene::Scene& s) { s.loading.clear(); }},
        {"/loading", "101 entries", [](scene::Scene& s) { s.loading.resize(101); }},
        {"/dimension", "grains need three dimensions", [](scene::Scene& s) { s.dimension = 2; }},
        {"/events/count", "2 events; a loading test is one event",
         [](scene::Scene& s) { s.events.count = 2; }},
        {"/ground", "takes no such part", [](scene::Scene& s) { s.ground.emplace(); }},
        {"/loading/0/speed", "0 is outside", [](scene::Scene& s) { s.loading[0].speed = 0; }},
        {"/loading/0/speed", "-1 is outside", [](scene::Scene& s) { s.loading[0].speed = -1; }},
        {"/loading/0/strain", "0 is outside", [](scene::Scene& s) { s.loading[0].strain = 0; }},
        {"/loading/0/strain", "compressed by 0.96 of its height in all; allowed: up to 0.95",
         [](scene::Scene& s) { s.loading[0].strain = 0.96; }},
        {"/loading/1/strain", "compressed by 0.96 of its height in all",
         [](scene::Scene& s) { s.loading[1] = {LoadingKind::isotropic, 0.02, 0.56, 0}; }},
        {"/loading/0/kind", "nothing to unload",
         [](scene::Scene& s) { s.loading[0].kind = LoadingKind::unload; }},
        {"/loading/4/kind", "has removed the top plate",
         [](scene::Scene& s) { s.loading[4].kind = LoadingKind::shear; }},
        {"/loading/2/kind", "\"stretch\" pulls at the plates; set /numerics/bonded_plates",
         [](scene::Scene& s) { s.loading[2] = {LoadingKind::stretch, 0.02, 0.1, 0}; }},
        {"/loading/2/stress", "\"stretch\" takes no stress",
         [](scene::Scene& s) {
           settings(s).bonded_plates = true;
           s.loading[2].kind = LoadingKind::stretch;
         }},
        {"/loading/3/stress", "\"penetrate\" takes no stress",
         [](scene::Scene& s) { s.loading[3].stress = 1; }},
        {"/cone", "no stage pushes it in", [](scene::Scene& s) { s.loading.resize(3); }},
        {"/cone/half_angle", "91 is outside", [](scene::Scene& s) { s.cone->half_angle = 91; }},
        {"/numerics/density_scaling", "0.5 is outside",
         [](scene::Scene& s) { settings(s).density_scaling = 0.5; }},
        {"/numerics/damping", "1 is outside", [](scene::Scene& s) { settings(s).damping = 1; }}}));

TEST(GrainsScene, OtherMethodsRefuseItsParts) {
  const std::string slab = R"({"snowshed": 2, "panel": {"height": 1, "length": 1, "width": 1},
    "slab": {"thickness": 0.1}, )";
  EXPECT_THROW(scene::parse_scene(slab + R"("sample": {"file": "a.npy", "voxel_size": 1e-4}})"),
               InputError);
  EXPECT_THROW(scene::parse_scene(slab + R"("loading": [{"kind": "hold"}]})"), InputError);
  EXPECT_THROW(scene::parse_scene(slab + R"("cone": {}})"), InputError);
  const std::string written = scene::write_scene(scene::parse_scene(slab + R"("ground": {}})"));
  EXPECT_EQ(written.find("loading"), std::string::npos);  // its hash does not change
}

}  // namespace
}  // namespace snowshed::methods::grains
