#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "scene/random_scene.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::scene {
namespace {

using nlohmann::json;

/// Visits every schema of an object: its properties are `schema["properties"]`.
template <class F>
void for_each_object(const json& schema, const std::string& path, const F& visit) {
  if (schema.contains("properties")) {
    visit(schema, path);
    for (const auto& [key, property] : schema["properties"].items())
      for_each_object(property, path + "/" + key, visit);
  }
  if (schema.contains("items")) for_each_object(schema["items"], path + "/*", visit);
  if (schema.contains("oneOf"))
    for (const auto& kind : schema["oneOf"])
      for_each_object(kind, path + "<" + kind["title"].get<std::string>() + ">", visit);
  if (schema.contains("anyOf"))
    for (const auto& alternative : schema["anyOf"]) for_each_object(alternative, path, visit);
}

const json& schema() {
  static const json schema = json::parse(scene_schema());
  return schema;
}

template <class F>
void for_each_object(const F& visit) {
  for_each_object(schema(), "", visit);
  for_each_object(schema()["$defs"]["shape"], "shape", visit);
}

/// "/panel/height", "shape<box>/size", ...
std::set<std::string> described_fields() {
  std::set<std::string> fields;
  for_each_object([&](const json& object, const std::string& path) {
    for (const auto& property : object["properties"].items())
      fields.insert(path + "/" + property.key());
  });
  return fields;
}

void collect_fields(const json& value, std::string path, std::set<std::string>& fields) {
  if (value.is_array())
    for (const auto& item : value) collect_fields(item, path + "/*", fields);
  if (!value.is_object()) return;
  if (value.contains("type")) path = "shape<" + value["type"].get<std::string>() + ">";
  for (const auto& [key, member] : value.items()) {
    fields.insert(path + "/" + key);
    collect_fields(member, path + "/" + key, fields);
  }
}

TEST(SceneSchema, HasExactlyTheFieldsOfScenes) {
  std::set<std::string> written;
  for (std::uint64_t seed = 1; seed < 200; seed += 2)  // 3D
    collect_fields(json::parse(write_scene(random_scene(seed))), "", written);
  const Scene halfspace =
      parse_scene(R"({"snowshed": 2, "obstacles": [{"shape": {"type": "plane"}}],
    "bodies": [{"shape": {"type": "sphere", "radius": 1}}],
    "domain": {"min": [-9, -9, -9], "max": [9, 9, 9]}})");
  collect_fields(json::parse(write_scene(halfspace)), "", written);
  written.insert("/method");  // not written for the default
  EXPECT_EQ(described_fields(), written);
}

TEST(SceneSchema, ObjectsAreClosedAndFieldsAreDescribed) {
  int objects = 0;
  for_each_object([&](const json& object, const std::string& path) {
    ++objects;
    EXPECT_EQ(object["additionalProperties"], false) << path;
    for (const auto& [key, property] : object["properties"].items()) {
      EXPECT_GT(property["description"].get<std::string>().size(), 3u) << path << "/" << key;
      EXPECT_TRUE(property.contains("type") || property.contains("enum") ||
                  property.contains("const") || property.contains("$ref") ||
                  property.contains("anyOf") || property.contains("oneOf"))
          << path << "/" << key;
    }
  });
  // The structs of scene.hpp except ShapeSpec, snow of layers and bodies, and the kinds of shape;
  // terrain with its areas and their holes, hydrographs and dams, and the settings of the slide;
  // sample, stage, cone and settings of grains; the settings of MPS.
  EXPECT_EQ(objects, 14 + 2 + 12 + 14 + 1 + 4 + 1);
}

TEST(SceneSchema, ContainsUnitsLimitsDefaultsAndChoices) {
  const json& properties = schema()["properties"];
  const json& numerics = properties["numerics"]["anyOf"][0]["properties"];
  const json density = {{"description", properties["snow"]["properties"]["density"]["description"]},
                        {"type", "number"},
                        {"exclusiveMinimum", 0.0},
                        {"maximum", 1000.0},
                        {"x-unit", "kg/m3"},
                        {"default", 210.0}};
  EXPECT_EQ(properties["snow"]["properties"]["density"], density);
  EXPECT_EQ(properties["snow"]["properties"]["poissons_ratio"]["exclusiveMaximum"], 0.5);
  EXPECT_EQ(numerics["precision"]["enum"], json::parse(R"(["float", "double"])"));
  EXPECT_EQ(properties["method"]["enum"], json::parse(R"(["mpm", "slide", "grains", "mps"])"));
  EXPECT_EQ(numerics["dx"]["x-accuracy"], true);
  EXPECT_FALSE(numerics["threads"].contains("x-accuracy"));
  EXPECT_EQ(numerics["courant_factor"]["x-aliases"], json::parse(R"(["step_factor"])"));
  EXPECT_EQ(properties["events"]["properties"]["count"]["type"], "integer");
  EXPECT_EQ(properties["snowshed"]["const"], 2);
  EXPECT_EQ(schema()["required"], json::parse(R"(["snowshed"])"));
  EXPECT_EQ(properties["panel"]["required"], json::parse(R"(["height", "length"])"));
  EXPECT_EQ(schema()["$defs"]["shape"]["oneOf"][1]["required"], json::parse(R"(["type", "size"])"));
}

TEST(SceneSchema, DefaultsLieInTheirRanges) {
  for_each_object([&](const json& object, const std::string& path) {
    for (const auto& [key, p] : object["properties"].items()) {
      if (!p.contains("default") || !p["default"].is_number()) continue;
      const double value = p["default"];
      EXPECT_GE(value, p.value("minimum", -1e300)) << path << "/" << key;
      EXPECT_LE(value, p.value("maximum", 1e300)) << path << "/" << key;
      EXPECT_GT(value, p.value("exclusiveMinimum", -1e300)) << path << "/" << key;
      EXPECT_LT(value, p.value("exclusiveMaximum", 1e300)) << path << "/" << key;
    }
  });
}

TEST(SceneSchema, TheCheckedInCopyIsUpToDate) {
  const std::string file = SNOWSHED_SOURCE_DIR "/docs/scene.schema.json";
  std::ostringstream copy;
  copy << std::ifstream(file).rdbuf();
  EXPECT_EQ(copy.str(), scene_schema()) << "write scene_schema() to " << file;
}

}  // namespace
}  // namespace snowshed::scene
