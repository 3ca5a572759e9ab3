#include "snowshed/scene/scene_json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/random_scene.hpp"
#include "scene/scene_equal.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/settings.hpp"

namespace snowshed::scene {
namespace {

const char* const minimal_scene = R"({"snowshed": 2, "bodies": [
  {"shape": {"type": "box", "center": [1, 2, 3], "size": [0.1, 0.2, 0.3]}}]})";

TEST(SceneJson, RandomScenesRoundTripExactly) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Scene scene = random_scene(seed);
    const std::string text = write_scene(scene);
    const Scene back = parse_scene(text);
    ASSERT_TRUE(back == scene) << "seed " << seed << "\n" << text;
    ASSERT_EQ(write_scene(back), text);
  }
}

TEST(SceneJson, MissingKeysTakeDefaults) {
  Scene expected;
  BodySpec& body = expected.bodies.emplace_back();
  body.shape.type = "box";
  body.shape.center = {1, 2, 3};
  body.shape.size = {0.1, 0.2, 0.3};
  EXPECT_TRUE(parse_scene(minimal_scene) == expected);
}

TEST(SceneJson, PartialSnowInheritsFromTheScenesSnow) {
  const Scene scene = parse_scene(R"({"snowshed": 2,
    "slab": {"layers": [{"thickness": 0.1}, {"thickness": 0.2, "event": 1, "snow": {"density": 90}}]},
    "bodies": [{"shape": {"type": "sphere", "radius": 1}, "snow": {"model": "elastic"}}],
    "snow": {"cohesion": 0.3, "density": 300},
    "panel": {"height": 1, "length": 1, "width": 1}})");
  ASSERT_EQ(scene.slab->layers.size(), 2u);
  EXPECT_FALSE(scene.slab->layers[0].snow);
  EXPECT_EQ(scene.slab->layers[0].event, 0);
  material::Snow light = scene.snow, elastic = scene.snow;
  light.density = 90;
  light.scale_from_density(300);
  elastic.model = material::SnowModel::elastic;
  EXPECT_EQ(light.cohesion, 0.3);
  ASSERT_TRUE(scene.slab->layers[1].snow);
  material::Snow layer = *scene.slab->layers[1].snow;
  EXPECT_NEAR(layer.youngs_modulus / light.youngs_modulus, 1, 1e-12);
  EXPECT_NEAR(layer.preconsolidation_pressure / light.preconsolidation_pressure, 1, 1e-12);
  layer.youngs_modulus = light.youngs_modulus;
  layer.preconsolidation_pressure = light.preconsolidation_pressure;
  EXPECT_TRUE(layer == light);
  EXPECT_EQ(scene.slab->layers[1].event, 1);
  EXPECT_TRUE(scene.bodies[0].snow == elastic);
}

TEST(SceneJson, StiffnessAndStrengthFollowFromTheDensityUnlessTheyAreGiven) {
  const auto snow = [](const char* text) {
    return parse_scene(std::string(R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere",
      "radius": 1}}], "snow": )") +
                       text + "}")
        .snow;
  };
  const material::Snow usual, light = snow(R"({"density": 105})");
  EXPECT_NEAR(light.youngs_modulus / usual.youngs_modulus, std::pow(0.5, 2.94), 1e-12);
  EXPECT_NEAR(light.preconsolidation_pressure / usual.preconsolidation_pressure,
              std::pow(0.5, 2.44), 1e-12);
  EXPECT_EQ(light.cohesion, usual.cohesion);
  const material::Snow given = snow(R"({"youngs_modulus": 5e5, "density": 105})");
  EXPECT_EQ(given.youngs_modulus, 5e5);
  EXPECT_EQ(given.preconsolidation_pressure, light.preconsolidation_pressure);
  EXPECT_TRUE(snow(R"({"density": 210})") == usual);
}

TEST(SceneJson, ALayersStrengthFollowsFromTheGivenStrengthOfTheScenesSnow) {
  const Scene scene =
      parse_scene(R"({"snowshed": 2, "panel": {"height": 1, "length": 1, "width": 1},
    "slab": {"layers": [{"thickness": 0.1, "snow": {"density": 105}},
                        {"thickness": 0.1, "snow": {"density": 105, "youngs_modulus": 3e5}}]},
    "snow": {"density": 210, "youngs_modulus": 2e6, "preconsolidation_pressure": 4000}})");
  const material::Snow& light = *scene.slab->layers[0].snow;
  EXPECT_NEAR(light.youngs_modulus, 2e6 * std::pow(0.5, 2.94), 1e-6);
  EXPECT_NEAR(light.preconsolidation_pressure, 4000 * std::pow(0.5, 2.44), 1e-9);
  EXPECT_EQ(scene.slab->layers[1].snow->youngs_modulus, 3e5);
}

TEST(SceneJson, EveryFieldIsRead) {
  const Scene scene = parse_scene(R"({
    "snowshed": 2, "dimension": 3, "title": "all", "gravity": 1.62,
    "snow": {"model": "elastic", "density": 300, "youngs_modulus": 2e6, "poissons_ratio": 0.2,
             "critical_state_slope": 0.6, "preconsolidation_pressure": 8000, "cohesion": 0.3,
             "hardening_factor": 1},
    "panel": {"height": 0.5, "length": 2, "width": 1.5, "tilt": 35, "thickness": 0.04,
              "condition": "separate", "friction": 0.1},
    "slab": {"thickness": 0.05, "length": 1.5, "width": 1},
    "ground": {"tilt": -5, "condition": "slip", "friction": 0.4},
    "obstacles": [{"name": "post", "condition": "sticky", "friction": 0.6,
      "shape": {"type": "cylinder", "from": [1, 2, 0], "to": [1, 2, 3], "radius": 0.1},
      "motion": {"velocity": [1, 2, 3], "angular_velocity": [4, 5, 6], "pivot": [7, 8, 9],
                 "start": 0.5, "end": 1.5}}],
    "bodies": [{"event": 2, "velocity": [0, 0, -1],
      "shape": {"type": "transform", "axis": [0, 0, 1], "angle": 30, "translate": [0, 0, 1],
                "shapes": [{"type": "sphere", "center": [1, 0, 0], "radius": 0.2}]}}],
    "domain": {"min": [-5, -4, -3], "max": [6, 5, 4]},
    "seeding": {"particles_per_voxel": 3, "pattern": "regular", "seed": 18446744073709551615,
                "allow_sparse": true},
    "numerics": {"dx": 0.02, "precision": "double", "transfer": "apic", "flip_ratio": 0.5,
                 "crack_band_length": 0.03, "relaxation_time": 0.0001, "contact": "touch", "contact_radius": 0.7,
                 "fields": "events", "event_friction": 0.5,
                 "basis": "cubic", "courant_factor": 0.3, "strain_limit": 0.1, "sleep_speed": 0.4,
                 "sleep_time": 0.7, "threads": 3},
    "events": {"count": 4, "between": "reseed", "max_time": 3, "rest_speed": 0.1,
               "rest_time": 0.2},
    "output": {"snapshot_interval": 0.25, "film": false, "film_interval": 0.5,
               "energy": true, "forces": true, "force_interval": 0.02, "checkpoint_interval": 30}})");
  EXPECT_EQ(scene.title, "all");
  EXPECT_EQ(scene.gravity, 1.62);
  EXPECT_TRUE(scene.snow ==
              (material::Snow{material::SnowModel::elastic, 300, 2e6, 0.2, 0.6, 8000, 0.3, 1}));
  EXPECT_TRUE(*scene.panel == (Panel{0.5, 2, 1.5, 35, 0.04, methods::Condition::separate, 0.1}));
  EXPECT_TRUE(*scene.slab == (Slab{0.05, 1.5, 1}));
  EXPECT_TRUE(*scene.ground == (Ground{-5, methods::Condition::slip, 0.4}));
  EXPECT_TRUE(*scene.domain == (Domain{Vec3(-5, -4, -3), Vec3(6, 5, 4)}));
  EXPECT_TRUE(scene.seeding ==
              (methods::Seeding{3, sampling::SeedPattern::regular, 18446744073709551615u, true}));
  EXPECT_TRUE(
      scene.numerics.as<methods::mpm::Settings>() ==
      (methods::mpm::Settings{methods::mpm::Scheme::thesis, 0.02, methods::mpm::Precision::float64,
                              methods::mpm::Transfer::apic, 0.5, std::nullopt, 0, 0.03, 1e-4,
                              methods::mpm::ContactRule::touch, 0.7, methods::mpm::Fields::events,
                              0.5, methods::mpm::Basis::cubic, 0.3, 0.1, 0.4, 0.7, 3}));
  EXPECT_TRUE(scene.events == (methods::Events{4, methods::Between::reseed, 3, 0.1, 0.2}));
  EXPECT_TRUE(scene.output == (methods::Output{0.25, false, 0.5, true, true, 0.02, 30}));

  ASSERT_EQ(scene.obstacles.size(), 1u);
  const ObstacleSpec& post = scene.obstacles[0];
  EXPECT_EQ(post.name, "post");
  EXPECT_EQ(post.condition, methods::Condition::sticky);
  EXPECT_EQ(post.friction, 0.6);
  EXPECT_EQ(post.shape.from, Vec3(1, 2, 0));
  EXPECT_EQ(post.shape.to, Vec3(1, 2, 3));
  EXPECT_EQ(post.shape.radius, 0.1);
  EXPECT_TRUE(*post.motion ==
              (geometry::MotionSpec{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9), 0.5, 1.5}));

  ASSERT_EQ(scene.bodies.size(), 1u);
  const BodySpec& body = scene.bodies[0];
  EXPECT_EQ(body.event, 2);
  EXPECT_EQ(body.velocity, Vec3(0, 0, -1));
  EXPECT_EQ(body.shape.axis, Vec3(0, 0, 1));
  EXPECT_EQ(body.shape.angle, 30);
  EXPECT_EQ(body.shape.translate, Vec3(0, 0, 1));
  EXPECT_EQ(body.shape.shapes.at(0).center, Vec3(1, 0, 0));
}

TEST(SceneJson, VectorsInPlaneScenesHaveTwoEntries) {
  const Scene scene = parse_scene(R"({"snowshed": 2, "dimension": 2,
    "obstacles": [{"shape": {"type": "plane", "center": [1, 2], "normal": [3, 4]},
                   "motion": {"angular_velocity": 5}}],
    "bodies": [{"velocity": [6, 7], "shape": {"type": "sphere", "radius": 1}}]})");
  EXPECT_EQ(scene.obstacles[0].shape.center, Vec3(1, 0, 2));
  EXPECT_EQ(scene.obstacles[0].shape.normal, Vec3(3, 0, 4));
  EXPECT_EQ(scene.obstacles[0].motion->angular_velocity, Vec3(0, 5, 0));
  EXPECT_EQ(scene.bodies[0].velocity, Vec3(6, 0, 7));
}

TEST(SceneJson, OrderOfKeysDoesNotMatter) {
  const Scene scene = parse_scene(R"({"bodies": [{"shape":
    {"size": [1, 2], "center": [3, 4], "type": "box"}}], "dimension": 2, "snowshed": 2})");
  EXPECT_EQ(scene.bodies[0].shape.size, Vec3(1, 0, 2));
}

TEST(SceneJson, IntegersMayHaveADecimalPoint) {
  const Scene scene = parse_scene(R"({"snowshed": 2, "dimension": 2.0, "seeding": {"seed": 5.0},
    "bodies": [{"shape": {"type": "sphere", "radius": 1}}]})");
  EXPECT_EQ(scene.dimension, 2);
  EXPECT_EQ(scene.seeding.seed, 5u);
}

TEST(SceneJson, OnlyKeysOfTheShapesTypeAreWritten) {
  const auto json = nlohmann::json::parse(write_scene(parse_scene(minimal_scene)));
  const auto shape = json.at("bodies").at(0).at("shape");
  EXPECT_EQ(shape, nlohmann::json::parse(
                       R"({"type": "box", "center": [1.0, 2.0, 3.0], "size": [0.1, 0.2, 0.3]})"));
  EXPECT_FALSE(json.contains("panel"));
  EXPECT_EQ(json.at("snow").at("density"), 210.0);
  EXPECT_EQ(json.at("numerics").at("precision"), "float");
}

TEST(SceneJson, NumbersSurviveToTheLastBit) {
  Scene scene = parse_scene(minimal_scene);
  for (const double number : {0.1, 1.0 / 3.0, 5e-324, 2.2250738585072014e-308, 999.99999999999989,
                              0.1 + 0.2, std::nextafter(1.0, 2.0)}) {
    scene.gravity = number;
    EXPECT_EQ(parse_scene(write_scene(scene)).gravity, number);
  }
  scene.bodies[0].shape.center.x() = -0.0;
  EXPECT_TRUE(std::signbit(parse_scene(write_scene(scene)).bodies[0].shape.center.x()));
}

TEST(SceneJson, InvalidScenesAreNotWritten) {
  Scene scene = parse_scene(minimal_scene);
  scene.snow.density = std::nan("");
  EXPECT_THROW(write_scene(scene), InputError);
  scene = parse_scene(minimal_scene);
  scene.title = "\xff";
  EXPECT_THROW(write_scene(scene), InputError);
}

TEST(SceneJson, ResolveFollowsPanelAndDimension) {
  Scene scene;
  scene.panel.emplace().length = 3.0;
  scene.panel->width = 1.5;
  scene.slab.emplace().thickness = 0.1;
  EXPECT_EQ(resolve(scene).slab->length, 3.0);
  EXPECT_EQ(resolve(scene).slab->width, 1.0);
  EXPECT_EQ(resolve(scene).seeding.particles_per_voxel, 8.0);
  scene.dimension = 2;
  EXPECT_EQ(resolve(scene).seeding.particles_per_voxel, 6.0);
  scene.slab->length = 2.0;
  scene.slab->width = 0.5;
  scene.seeding.particles_per_voxel = 9.0;
  EXPECT_TRUE(resolve(scene) == scene);
}

class SceneFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path save(const std::string& text) const {
    std::ofstream(folder_ / "scene.json") << text;
    return folder_ / "scene.json";
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("snowshed_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(SceneFile, LoadsTheParsedScene) {
  EXPECT_TRUE(load_scene(save(minimal_scene)) == parse_scene(minimal_scene));
}

TEST_F(SceneFile, PathsAreRelativeToTheScene) {
  const Scene scene = load_scene(save(R"({"snowshed": 2,
    "bodies": [{"shape": {"type": "union", "shapes": [{"type": "mesh", "file": "a/b.stl"}]}}],
    "obstacles": [{"shape": {"type": "grid", "file": "/abs.npy", "spacing": 1}}]})"));
  EXPECT_EQ(scene.bodies[0].shape.shapes[0].file,
            (std::filesystem::absolute(folder_) / "a/b.stl").string());
  EXPECT_EQ(scene.obstacles[0].shape.file, "/abs.npy");
}

TEST_F(SceneFile, ErrorsNameTheFile) {
  const auto file = save("{\n \"snowshed\": 1,\n \"snow\": {\"density\": -1}}");
  try {
    load_scene(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "/snow/density");
    EXPECT_EQ(error.what(),
              "/snow/density: -1 is outside the allowed range (0 < value <= 1000 "
              "kg/m3) [in " +
                  file.string() + "]");
  }
}

TEST_F(SceneFile, SyntaxErrorsNameFileLineAndColumn) {
  const auto file = save("{\n \"snowshed\": 1,\n \"title\": oops}");
  try {
    load_scene(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), file.string() + ":3:11");
  }
}

TEST_F(SceneFile, UnreadablePathsAreNamed) {
  for (const auto& path : {folder_ / "absent.json", folder_}) {
    try {
      load_scene(path);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), path.string());
    }
  }
}

TEST(SceneJson, TheDefaultMethodIsNotWritten) {
  const std::string base =
      R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere", "radius": 1}}])";
  const Scene scene = parse_scene(base + R"(, "numerics": {"dx": 0.02}, "method": "mpm"})");
  EXPECT_EQ(scene.numerics.as<methods::mpm::Settings>().dx, 0.02);
  EXPECT_EQ(write_scene(scene), write_scene(parse_scene(base + R"(, "numerics": {"dx": 0.02}})")));
  EXPECT_FALSE(nlohmann::json::parse(write_scene(scene)).contains("method"));
}

// `slip` of version 1 is `separate` now. The meaning of a scene of version 1 must not change.
TEST(SceneJson, SlipInVersion1IsReadAsSeparate) {
  const std::string rest = R"(, "ground": {"condition": "slip"}, "slab": {"thickness": 0.1},
    "panel": {"height": 1, "length": 2, "width": 3, "condition": "slip"},
    "obstacles": [{"shape": {"type": "plane"}, "condition": "sticky"},
                  {"shape": {"type": "plane"}, "condition": "slip"}]})";
  std::vector<std::string> notes;
  const Scene old = parse_scene("{\"snowshed\": 1" + rest, "scene", &notes);
  EXPECT_EQ(old.panel->condition, methods::Condition::separate);
  EXPECT_EQ(old.ground->condition, methods::Condition::separate);
  EXPECT_EQ(old.obstacles[0].condition, methods::Condition::sticky);
  EXPECT_EQ(old.obstacles[1].condition, methods::Condition::separate);
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_EQ(
      notes[0],
      "/panel/condition: \"slip\" of version 1 is read as \"separate\", its name since version "
      "2; there \"slip\" holds snow on the surface except at its edge");
  EXPECT_EQ(notes[2].rfind("/obstacles/1/condition: ", 0), 0u);
  EXPECT_NE(write_scene(old).find("\"snowshed\": 2"), std::string::npos);

  notes.clear();
  const Scene present = parse_scene("{\"snowshed\": 2" + rest, "scene", &notes);
  EXPECT_EQ(present.panel->condition, methods::Condition::slip);
  EXPECT_EQ(present.obstacles[1].condition, methods::Condition::slip);
  EXPECT_TRUE(notes.empty());
}

TEST(SceneJson, ASchemeSetsMechanismsThatAreNotGiven) {
  const auto numerics = [](const std::string& given) {
    return parse_scene(
               R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere", "radius": 1}}],
                           "numerics": {)" +
               given + "}}")
        .numerics.as<methods::mpm::Settings>();
  };
  methods::mpm::Settings expected;
  expected.adopt(methods::mpm::Scheme::objective);
  EXPECT_TRUE(numerics(R"("scheme": "objective")") == expected);
  EXPECT_EQ(expected.transfer, methods::mpm::Transfer::affine_flip);
  EXPECT_EQ(*expected.damping_rate, 380.0);
  expected.damping_rate = 190;
  expected.crack_band_length = 0.02;
  expected.dx = 0.02;
  const std::string given =
      R"("crack_band_length": 0.02, "dx": 0.02, "damping_rate": 190, "scheme": "objective")";
  EXPECT_TRUE(numerics(given) == expected);
  EXPECT_TRUE(numerics(R"("scheme": "thesis")") == methods::mpm::Settings{});
  expected = {};
  expected.contact = methods::mpm::ContactRule::touch;  // a mechanism alone
  EXPECT_TRUE(numerics(R"("contact": "touch")") == expected);
}

TEST(SceneJson, ADampingRateReplacesTheFlipRatio) {
  const Scene scene = parse_scene(R"({"snowshed": 2, "numerics": {"damping_rate": 50},
    "bodies": [{"shape": {"type": "sphere", "radius": 1}}]})");
  EXPECT_EQ(scene.numerics.as<methods::mpm::Settings>().damping_rate, 50.0);
  const auto written = nlohmann::json::parse(write_scene(scene));
  EXPECT_EQ(written["numerics"]["damping_rate"], 50.0);
  EXPECT_FALSE(written["numerics"].contains("flip_ratio"));
  EXPECT_TRUE(parse_scene(write_scene(scene)) == scene);
}

TEST(SceneJson, AliasesOfKeysAreRead) {
  const Scene scene = parse_scene(R"({"snowshed": 2, "slab": {"thickness": 0.1},
    "panel": {"lower_edge_height": 1, "slant_height": 2, "width": 3, "surface_tilt": 45},
    "numerics": {"step_factor": 0.5}})");
  EXPECT_TRUE(*scene.panel == (Panel{1, 2, 3, 45, 0, methods::Condition::separate, 0.3}));
  EXPECT_EQ(scene.numerics.as<methods::mpm::Settings>().courant_factor, 0.5);
  const auto written = nlohmann::json::parse(write_scene(scene));
  EXPECT_EQ(written["numerics"]["courant_factor"], 0.5);
  EXPECT_FALSE(written["numerics"].contains("step_factor"));
}

}  // namespace
}  // namespace snowshed::scene
