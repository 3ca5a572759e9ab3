// Every kind of invalid input gives one InputError, which names the path and what is allowed.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::scene {
namespace {

struct InvalidPart {
  const char* rest;  // text after {"snowshed": 2, "bodies": [...]
  const char* where;
  const char* message;  // all of it, after the path
};

const std::string good =
    R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere", "radius": 1}}])";

void expect_error(const std::string& text, const std::string& where, const std::string& message) {
  try {
    parse_scene(text);
    ADD_FAILURE() << "accepted " << text.substr(0, 200);
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), where) << text.substr(0, 200);
    EXPECT_EQ(error.what(), where + ": " + message) << text.substr(0, 200);
  }
}

void PrintTo(const InvalidPart& bad, std::ostream* out) { *out << bad.rest; }

class SceneErrors : public testing::TestWithParam<InvalidPart> {};

TEST(SceneErrorsBase, TheUnchangedSceneIsValid) { EXPECT_NO_THROW(parse_scene(good + "}")); }

TEST_P(SceneErrors, NamePathAndCause) {
  expect_error(good + GetParam().rest + "}", GetParam().where, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Range, SceneErrors,
    testing::ValuesIn(std::vector<InvalidPart>{
        {R"(, "snow": {"poissons_ratio": 0.5})", "/snow/poissons_ratio",
         "0.5 is outside the allowed range (0 <= value < 0.5)"},
        {R"(, "snow": {"density": 0})", "/snow/density",
         "0 is outside the allowed range (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": {"density": 1000.5})", "/snow/density",
         "1000.5 is outside the allowed range (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": {"youngs_modulus": 0})", "/snow/youngs_modulus",
         "0 is outside the allowed range (0 < value <= 1000000000000 Pa)"},
        {R"(, "snow": {"critical_state_slope": -0.1})", "/snow/critical_state_slope",
         "-0.1 is outside the allowed range (0 <= value <= 100)"},
        {R"(, "snow": {"preconsolidation_pressure": 0})", "/snow/preconsolidation_pressure",
         "0 is outside the allowed range (0 < value <= 1000000000000 Pa)"},
        {R"(, "snow": {"cohesion": 1.01})", "/snow/cohesion",
         "1.01 is outside the allowed range (0 <= value <= 1)"},
        {R"(, "snow": {"hardening_factor": 0})", "/snow/hardening_factor",
         "0 is outside the allowed range (0 < value <= 1000)"},
        {R"(, "panel": {"height": 1, "length": 1, "width": 1, "tilt": 91})", "/panel/tilt",
         "91 is outside the allowed range (0 <= value <= 90 degrees)"},
        {R"(, "panel": {"height": 1, "length": 0, "width": 1})", "/panel/length",
         "0 is outside the allowed range (0 < value <= 1000000 m)"},
        {R"(, "panel": {"height": -1, "length": 1, "width": 1})", "/panel/height",
         "-1 is outside the allowed range (0 <= value <= 1000000 m)"},
        {R"(, "panel": {"height": 1, "length": 1, "width": 0})", "/panel/width",
         "0 is outside the allowed range (0 < value <= 1000000 m)"},
        {R"(, "panel": {"height": 1, "length": 1, "width": 1, "friction": -1})", "/panel/friction",
         "-1 is outside the allowed range (0 <= value <= 100)"},
        {R"(, "ground": {"tilt": 60})", "/ground/tilt",
         "60 is outside the allowed range (-60 < value < 60 degrees)"},
        {R"(, "numerics": {"dx": 0})", "/numerics/dx",
         "0 is outside the allowed range (0 < value <= 1000000 m)"},
        {R"(, "numerics": {"flip_ratio": 1.5})", "/numerics/flip_ratio",
         "1.5 is outside the allowed range (0 <= value <= 1)"},
        {R"(, "method": "mpn")", "/method",
         R"("mpn" is none of "mpm", "slide", "grains", "mps"; did you mean "mpm"?)"},
        {R"(, "numerics": {"flip_ratio": 0.9, "damping_rate": 5})", "/numerics/damping_rate",
         "takes the place of /numerics/flip_ratio; give one of the two"},
        {R"(, "numerics": {"damping_rate": -1})", "/numerics/damping_rate",
         "-1 is outside the allowed range (0 <= value <= 1000000000 1/s)"},
        {R"(, "numerics": {"damping_rate": 5, "transfer": "apic"})", "/numerics/damping_rate",
         R"(the transfer "apic" has no PIC damping; leave damping_rate out)"},
        {R"(, "numerics": {"damping_rate": 5, "damping_length": 0.01})", "/numerics/damping_length",
         R"(needs the transfer "affine_flip", not "flip")"},
        {R"(, "numerics": {"transfer": "affine_flip", "damping_length": 0.01})",
         "/numerics/damping_length", "needs a damping_rate, too"},
        {R"(, "numerics": {"scheme": "objective", "transfer": "apic"})", "/numerics/transfer",
         R"(is "apic", but the scheme "objective" requires "affine_flip"; remove this setting or the scheme)"},
        {R"(, "numerics": {"scheme": "objective", "flip_ratio": 0.9})", "/numerics/damping_length",
         "needs a damping_rate, too"},
        {R"(, "numerics": {"scheme": "objective", "fields": "one"})", "/numerics/fields",
         R"(is "one", but the scheme "objective" requires "events"; remove this setting or the scheme)"},
        {R"(, "numerics": {"dx": 0.01, "crack_band_length": 1})", "/numerics/crack_band_length",
         "is 100 times dx; it must be 0.01 to 10 times"},
        {R"(, "numerics": {"dx": 0.01, "crack_band_length": 5e-5})", "/numerics/crack_band_length",
         "is 0.005 times dx; it must be 0.01 to 10 times"},
        {R"(, "numerics": {"courant_factor": 0.5, "step_factor": 0.5})", "/numerics/step_factor",
         "means the same as /numerics/courant_factor; give one of the two"},
        {R"(, "numerics": {"step_factr": 0.5})", "/numerics/step_factr",
         R"(unknown key; did you mean "step_factor"?)"},
        {R"(, "numerics": {"courant_factor": 0})", "/numerics/courant_factor",
         "0 is outside the allowed range (0 < value <= 1)"},
        {R"(, "numerics": {"strain_limit": 0.6})", "/numerics/strain_limit",
         "0.6 is outside the allowed range (0 < value <= 0.5)"},
        {R"(, "numerics": {"threads": -1})", "/numerics/threads",
         "-1 is outside the allowed range (0 <= value <= 4096)"},
        {R"(, "events": {"count": 0})", "/events/count",
         "0 is outside the allowed range (1 <= value <= 1000)"},
        {R"(, "events": {"count": 1001})", "/events/count",
         "1001 is outside the allowed range (1 <= value <= 1000)"},
        {R"(, "events": {"max_time": 0})", "/events/max_time",
         "0 is outside the allowed range (0 < value <= 1000000000 s)"},
        {R"(, "gravity": -9.81)", "/gravity",
         "-9.81 is outside the allowed range (0 <= value <= 1000 m/s2)"},
        {R"(, "dimension": 4)", "/dimension", "4 is outside the allowed range (2 <= value <= 3)"},
        {R"(, "obstacles": [{"shape": {"type": "box", "size": [1, 0, 1]}}])",
         "/obstacles/0/shape/size/1", "0 is outside the allowed range (0 < value <= 1000000 m)"},
        {R"(, "obstacles": [{"shape": {"type": "plane", "normal": [0, 0, 0]}}])",
         "/obstacles/0/shape/normal", "a direction must not be zero"}}));

INSTANTIATE_TEST_SUITE_P(
    Type, SceneErrors,
    testing::ValuesIn(std::vector<InvalidPart>{
        {R"(, "snow": {"density": "heavy"})", "/snow/density",
         "\"heavy\" is not a number (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": {"density": null})", "/snow/density",
         "null is not a number (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": {"density": true})", "/snow/density",
         "true is not a number (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": [])", "/snow", "an array is not an object"},
        {R"(, "snow": null)", "/snow", "null is not an object"},
        {R"(, "panel": 1)", "/panel", "1 is not an object"},
        {R"(, "title": 3)", "/title", "3 is not a text"},
        {R"(, "output": {"energy": 1})", "/output/energy", "1 is not true or false"},
        {R"(, "events": {"count": 2.5})", "/events/count",
         "2.5 is not a whole number (1 <= value <= 1000)"},
        {R"(, "obstacles": {})", "/obstacles", "an object is not an array"},
        {R"(, "obstacles": [7])", "/obstacles/0", "7 is not an object"},
        {R"(, "numerics": {"precision": "floot"})", "/numerics/precision",
         "\"floot\" is none of \"float\", \"double\"; did you mean \"float\"?"},
        {R"(, "numerics": {"basis": 2})", "/numerics/basis",
         "2 is none of \"quadratic\", \"cubic\""},
        {R"(, "domain": {"min": [0, 0], "max": [1, 1, 1]})", "/domain/min",
         "an array of 2 is not an array of 3 numbers (x, y, z; the scene is 3D)"},
        {R"(, "dimension": 2, "domain": {"min": [0, 0, 0], "max": [1, 1]})", "/domain/min",
         "an array of 3 is not an array of 2 numbers (x, z; the scene is 2D)"},
        {R"(, "domain": {"min": [0, 0, "a"], "max": [1, 1, 1]})", "/domain/min/2",
         "\"a\" is not a number"},
        {R"(, "domain": {"min": 0, "max": [1, 1, 1]})", "/domain/min",
         "0 is not an array of 3 numbers (x, y, z; the scene is 3D)"}}));

INSTANTIATE_TEST_SUITE_P(
    TooLarge, SceneErrors,
    testing::ValuesIn(std::vector<InvalidPart>{
        {R"(, "gravity": 1e999)", "/gravity", "1e999 is too large for a number"},
        {R"(, "obstacles": [{"name": "a"}, {"motion": {"start": -1e999}}])",
         "/obstacles/1/motion/start", "-1e999 is too large for a number"},
        {R"(, "domain": {"min": [0, 1e400, 0]})", "/domain/min/1",
         "1e400 is too large for a number"},
        {R"(, "seeding": {"seed": 18446744073709551616})", "/seeding/seed",
         "1.8446744073709552e+19 is above 18446744073709551615, the largest allowed"},
        {R"(, "seeding": {"seed": -1})", "/seeding/seed",
         "-1 is outside the allowed range (0 <= value)"},
        {R"(, "numerics": {"threads": 4294967297})", "/numerics/threads",
         "4294967297 is outside the allowed range (0 <= value <= 4096)"},
        {R"(, "events": {"count": 1e300})", "/events/count",
         "1e+300 is outside the allowed range (1 <= value <= 1000)"},
        {R"(, "gravity": 100000000000000000000)", "/gravity",
         "1e+20 is outside the allowed range (0 <= value <= 1000 m/s2)"}}));

INSTANTIATE_TEST_SUITE_P(
    Keys, SceneErrors,
    testing::ValuesIn(std::vector<InvalidPart>{
        {R"(, "snow": {"densty": 200})", "/snow/densty", "unknown key; did you mean \"density\"?"},
        {R"(, "ground": {"colour": 1})", "/ground/colour",
         "unknown key; allowed: \"tilt\", \"condition\", \"friction\""},
        {R"(, "pannel": {})", "/pannel", "unknown key; did you mean \"panel\"?"},
        {R"(, "loading": [])", "/loading",
         "the method \"mpm\" takes no such part; methods that do: grains"},
        {R"(, "method": "slide", "snow": {})", "/snow",
         "the method \"slide\" takes no such part; methods that do: mpm"},
        {R"(, "slab": {"a/b~c": 1, "thickness": 1})", "/slab/a~1b~0c",
         "unknown key; allowed: \"thickness\", \"length\", \"width\", \"layers\""},
        {R"(, "panel": {"heigth": 1, "length": 1, "width": 1})", "/panel/heigth",
         "unknown key; did you mean \"height\"?"},
        {R"(, "panel": {"length": 1, "width": 1})", "/panel/height",
         "missing: a number (0 <= value <= 1000000 m) is required"},
        {R"(, "panel": {"height": 1, "length": 1})", "/panel/width",
         "missing: a number (0 < value <= 1000000 m) is required"},
        {R"(, "slab": {"layers": [{}]})", "/slab/layers/0/thickness",
         "missing: a number (0 < value <= 1000000 m) is required"},
        {R"(, "slab": {"layers": [{"thickness": 1}, {"thickness": 1, "snow": {"density": -1}}]})",
         "/slab/layers/1/snow/density",
         "-1 is outside the allowed range (0 < value <= 1000 kg/m3)"},
        {R"(, "snow": {"densty": 1}, "slab": {"layers": [{"thickness": 1, "snow": {}}]})",
         "/snow/densty", "unknown key; did you mean \"density\"?"},
        {R"(, "slab": {"layers": [{"thickness": 1, "snow": 3}]})", "/slab/layers/0/snow",
         "3 is not an object"},
        {R"(, "domain": {"min": [0, 0, 0]})", "/domain/max",
         "missing: an array of 3 numbers (x, y, z; the scene is 3D) is required"},
        {R"(, "snow": {"density": 200, "density": 300})", "/snow/density",
         "this key appears twice, the second time in line 1"},
        {R"(, "snow": {}, "snow": {})", "/snow",
         "this key appears twice, the second time in line 1"},
        {","
         "\n"
         R"("obstacles": [{}, {"name" : "a:\"",)"
         "\n"
         R"("name")"
         "\n"
         R"(: "b"}])",
         "/obstacles/1/name", "this key appears twice, the second time in line 3"},
        {R"(, "obstacles": [{}])", "/obstacles/0/shape", "missing: an object is required"}}));

INSTANTIATE_TEST_SUITE_P(
    Shape, SceneErrors,
    testing::ValuesIn(std::vector<InvalidPart>{
        {R"(, "obstacles": [{"shape": {}}])", "/obstacles/0/shape/type",
         "missing: a text is required"},
        {R"(, "obstacles": [{"shape": {"type": 1}}])", "/obstacles/0/shape/type",
         "1 is not a text"},
        {R"(, "obstacles": [{"shape": {"type": "spere"}}])", "/obstacles/0/shape/type",
         "\"spere\" is none of \"plane\", \"box\", \"sphere\", \"cylinder\", \"capsule\", "
         "\"plate\", "
         "\"mesh\", \"grid\", \"vdb\", \"union\", \"difference\", \"transform\"; did you mean "
         "\"sphere\"?"},
        {R"(, "obstacles": [{"shape": {"type": "sphere", "radius": 1, "size": [1, 1, 1]}}])",
         "/obstacles/0/shape/size", "unknown key; allowed: \"type\", \"center\", \"radius\""},
        {R"(, "obstacles": [{"shape": {"type": "sphere"}}])", "/obstacles/0/shape/radius",
         "missing: a number (0 < value <= 1000000 m) is required"},
        {R"(, "obstacles": [{"shape": {"type": "capsule", "to": [0, 0, 1], "radius": 1}}])",
         "/obstacles/0/shape/from",
         "missing: an array of 3 numbers (x, y, z; the scene is 3D) is required"},
        {R"(, "obstacles": [{"shape": {"type": "mesh"}}])", "/obstacles/0/shape/file",
         "missing: a file name is required"},
        {R"(, "obstacles": [{"shape": {"type": "mesh", "file": ""}}])", "/obstacles/0/shape/file",
         "\"\" is not the name of a file"},
        {R"(, "obstacles": [{"shape": {"type": "mesh", "file": "a\u0000b"}}])",
         "/obstacles/0/shape/file", "\"a\\u0000b\" is not the name of a file"},
        {R"(, "obstacles": [{"shape": {"type": "union", "shapes": []}}])",
         "/obstacles/0/shape/shapes",
         "0 entries are outside the allowed number (1 <= value <= 10000)"},
        {R"(, "obstacles": [{"shape": {"type": "difference", "shapes": [
          {"type": "sphere", "radius": 1}]}}])",
         "/obstacles/0/shape/shapes",
         "1 entries are outside the allowed number (2 <= value <= 10000)"},
        {R"(, "obstacles": [{"shape": {"type": "transform", "shapes": [
          {"type": "sphere", "radius": -1}]}}])",
         "/obstacles/0/shape/shapes/0/radius",
         "-1 is outside the allowed range (0 < value <= 1000000 m)"},
        {R"(, "dimension": 2, "obstacles": [{"shape": {"type": "transform", "axis": [1, 0], "shapes": [
          {"type": "sphere", "radius": 1}]}}])",
         "/obstacles/0/shape/axis",
         "unknown key; allowed: \"type\", \"shapes\", \"angle\", \"translate\""}}));

TEST(SceneErrorsText, TheDocumentIsAnObjectWithAVersion) {
  expect_error("[]", "/", "an array is not an object");
  expect_error("null", "/", "null is not an object");
  expect_error("{}", "/snowshed", "missing: the version 2 is required");
  expect_error(R"({"snowshed": 3})", "/snowshed",
               "3 is not a version that this program reads (1 to 2)");
  expect_error(R"({"snowshed": "2"})", "/snowshed",
               "\"2\" is not a version that this program reads (1 to 2)");
}

std::string where_of(const std::string& text) {
  try {
    parse_scene(text, "name");
  } catch (const InputError& error) {
    return error.where();
  }
  return "accepted";
}

TEST(SceneErrorsText, SyntaxErrorsHaveLineAndColumn) {
  EXPECT_EQ(where_of(""), "name:1:1");
  EXPECT_EQ(where_of("{\n  \"a\": NaN}"), "name:2:8");
  EXPECT_EQ(where_of("{\"a\": Infinity}"), "name:1:7");
  EXPECT_EQ(where_of("{\"a\": 1,}"), "name:1:9");
  EXPECT_EQ(where_of("{\"a\": 1}\n\n x"), "name:3:2");
  EXPECT_EQ(where_of("{\"a\": 'x'}"), "name:1:7");
  EXPECT_EQ(where_of("{\"a\": \"\xff\"}"), "name:1:8");
  EXPECT_EQ(where_of("// comment\n{}"), "name:1:1");
}

TEST(SceneErrorsText, MessagesAreShortAndPrintable) {
  for (const std::string& text :
       {std::string("{\"a\": \"\xff\xfe\x01"), "{\"a\": \"" + std::string(100000, 'x') + "\n\"}",
        "{\"" + std::string(100000, '\\') + "\": 1}", std::string("{\"a\": \0}", 8)}) {
    try {
      parse_scene(text);
      FAIL();
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_LT(message.size(), 400u);
      EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) {
        return c >= ' ' && c <= '~';
      })) << message;
    }
  }
}

TEST(SceneErrorsText, DepthIsLimitedWithoutRecursion) {
  EXPECT_THROW(parse_scene(std::string(1 << 22, '[')), InputError);
  std::string path;
  for (int i = 0; i < 64; ++i) path += "/0";
  expect_error(std::string(65, '['), path, "nested more than 64 deep");
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_THROW(parse_scene(objects), InputError);
}

TEST(SceneErrorsText, ShapesMayNestSixteenDeep) {
  const auto nested = [](int depth) {
    std::string text = R"({"type": "sphere", "radius": 1})";
    for (int i = 1; i < depth; ++i) text = R"({"type": "union", "shapes": [)" + text + "]}";
    return good + R"(, "obstacles": [{"shape": )" + text + "}]}";
  };
  EXPECT_NO_THROW(parse_scene(nested(16)));
  std::string path = "/obstacles/0/shape";
  for (int i = 0; i < 16; ++i) path += "/shapes/0";
  expect_error(nested(17), path, "shapes are nested more than 16 deep");
}

TEST(SceneErrorsText, SizeIsLimited) {
  expect_error(std::string((64 << 20) + 1, ' '), "scene", "longer than 64 MB");
  std::string values = "[0";
  for (int i = 0; i < 1000000; ++i) values += ",0";
  EXPECT_EQ(where_of(values + "]"), "/999999");
}

TEST(SceneErrorsText, TheMaximumOfShapesCanBeWrittenAndRead) {
  const auto with_shapes = [](int each) {
    std::string text = good + R"(, "obstacles": [)";
    for (int i = 0; i < 1000; ++i) {
      text += R"({"motion": {}, "shape": {"type": "union", "shapes": [)";
      for (int k = 1; k < each; ++k)
        text += R"({"type": "plate", "length": 1, "width": 1, "thickness": 1},)";
      text.back() = ']';
      text += i < 999 ? "}}," : "}}";
    }
    return text + "]}";
  };
  EXPECT_NO_THROW(parse_scene(write_scene(parse_scene(with_shapes(49)))));
  expect_error(with_shapes(51), "/", "51001 shapes in all; at most 50000 are allowed");
}

TEST(SceneErrorsText, MessagesOmitBlankLines) {
  const auto message_for = [](const std::string& text) {
    return io::message_of<InputError>([&] { parse_scene(text); });
  };
  const std::string message = message_for("\n\t\r\n\n ?");
  EXPECT_EQ(message.substr(0, 26), "scene:4:2: not valid JSON:");
  EXPECT_EQ(message.substr(message.rfind(", after")), ", after \"?\"");
  // The parser's own message would have nine bytes for each blank, several times over.
  EXPECT_LT(message_for(std::string(1 << 22, '\n') + "x").size(), 200u);
  EXPECT_EQ(where_of("{\"a\\\"\n\": 1}"), "name:1:6");  // within a text they remain escaped
}

TEST(SceneErrorsText, DamagedTextNeverCrashes) {
  const std::string valid_text = write_scene(parse_scene(good + R"(, "ground": {}, "obstacles": [
    {"shape": {"type": "transform", "shapes": [{"type": "mesh", "file": "a.stl"}]}, "motion": {}}],
    "domain": {"min": [-9, -9, -9], "max": [9, 9, 9]}})"));
  std::mt19937 random(1);
  int accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = valid_text;
    for (int damage = 0; damage < 1 + i % 3; ++damage) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 20));
          break;
        case 3:
          text[at] = "{}[]\",:0123456789.e-+tfn"[random() % 24];
          break;
      }
    }
    try {
      const Scene scene = parse_scene(text);
      EXPECT_EQ(write_scene(parse_scene(write_scene(scene))), write_scene(scene));
      ++accepted;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(accepted, 30);  // harmless damage, so that the loop tests more than the syntax
  EXPECT_LT(accepted, 2900);
}

TEST(SceneErrorsText, ScenesBuiltInCodeObeyTheSameRanges) {
  Scene scene = parse_scene(good + "}");
  const auto where = [&] {
    try {
      validate(scene);
    } catch (const InputError& error) {
      return error.where();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(where(), "accepted");
  scene.gravity = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(where(), "/gravity");
  scene.gravity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(where(), "/gravity");
  scene.gravity = 9.81;
  scene.bodies[0].shape.type = "blob";
  EXPECT_EQ(where(), "/bodies/0/shape/type");
  scene.bodies[0].shape.type = "transform";
  EXPECT_EQ(where(), "/bodies/0/shape/shapes");
  scene.bodies[0].shape.type = "sphere";
  scene.numerics.as<methods::mpm::Settings>().basis = static_cast<methods::mpm::Basis>(17);
  EXPECT_EQ(where(), "/numerics/basis");
  scene.numerics.as<methods::mpm::Settings>().basis = methods::mpm::Basis::cubic;
  scene.dimension = 5;
  EXPECT_EQ(where(), "/dimension");
}

TEST(SceneErrorsText, NulCharactersAreRefused) {
  const std::string text = good + "}";
  for (const std::string& rest : {std::string(1, '\0'), std::string("\0junk", 5)}) try {
      parse_scene(text + rest);
      FAIL() << rest.size();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("a NUL character"), std::string::npos);
    }
}

}  // namespace
}  // namespace snowshed::scene
