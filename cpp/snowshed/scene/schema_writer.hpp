// Visitor that turns the description of a scene into JSON Schema.
#pragma once

#include <cmath>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "snowshed/methods/registry.hpp"
#include "snowshed/scene/describe.hpp"

namespace snowshed::scene {

class SchemaWriter {
 public:
  using json = nlohmann::ordered_json;

  /// `definitions` is shared by all visitors of one schema. It holds the types that contain
  /// themselves, to which the schema therefore refers.
  explicit SchemaWriter(json& definitions) : definitions_(definitions) {}

  /// The schema of T; its defaults are those of a new T.
  template <class T>
  static json write(json& definitions, T defaults = {}) {
    SchemaWriter writer(definitions);
    describe(writer, defaults);
    return writer.finish();
  }

  void version(const char* key, int number, const char* doc) {
    add(key, {{"const", number}}, doc, methods::Need::required);
  }

  void number(const char* key, double& value, const char* unit, const methods::Range& range,
              const char* doc) {
    // The range that either dimension allows.
    const json schema = limited("number", range.in(2), unit);
    add(key, with_default(schema, value, range.need), doc, range.need);
  }

  void number_instead(const char* key, std::optional<double>&, const char* other, const char* unit,
                      const methods::Range& range, const char* doc) {
    json schema = limited("number", range, unit);
    schema["x-instead-of"] = other;
    add(key, schema, doc);
  }

  template <class Int>
  void integer(const char* key, Int& value, const methods::Range& range, const char* doc) {
    add(key, with_default(limited("integer", range), value, range.need), doc, range.need);
  }

  void flag(const char* key, bool& value, const char* doc) {
    add(key, {{"type", "boolean"}, {"default", value}}, doc);
  }

  void text(const char* key, std::string& value, const char* doc) {
    add(key, {{"type", "string"}, {"default", value}}, doc);
  }

  void file(const char* key, std::string&, const char* doc) {
    add(key, {{"type", "string"}, {"minLength", 1}}, doc, methods::Need::required);
  }

  void choice(const char* key, const methods::Choice& value, const char* doc) {
    add(key, {{"enum", value.names()}, {"default", value.name()}}, doc);
  }

  void vector(const char* key, Vec3& value, const char* unit, const methods::Range& range,
              const char* doc) {
    add(key, with_default(array(limited("number", range), 2, unit), entries(value), range.need),
        doc, range.need);
  }

  void direction(const char* key, Vec3& value, const char* doc) {
    vector(key, value, "", methods::anything, doc);
  }

  void axis(const char* key, Vec3& value, const char* doc) {
    json schema = array(limited("number", methods::anything), 3, "");
    add(key, with_default(std::move(schema), entries(value), methods::Need::optional),
        std::string(doc) + " (3D only; +y in 2D)");
  }

  void spin(const char* key, Vec3&, const char* unit, const methods::Range& range,
            const char* doc) {
    const json component = limited("number", range);
    json schema = {{"anyOf", json::array({component, array(component, 3, "")})}, {"x-unit", unit}};
    add(key, schema, std::string(doc) + "; in 2D a single number, about +y");
  }

  void outline(const char* key, geometry::Ring&, const char* doc) {
    const json corner = {{"type", "array"},
                         {"items", limited("number", methods::allowed::map_coordinate)},
                         {"minItems", 2},
                         {"maxItems", 2}};
    add(key, {{"type", "array"}, {"items", corner}, {"minItems", 3}, {"x-unit", "m"}}, doc,
        methods::Need::required);
  }

  template <class T>
  void object(const char* key, T&, methods::Need need, const char* doc) {
    add(key, schema_of<T>(), doc, need);
  }

  template <class T>
  void optional(const char* key, std::optional<T>&, const char* doc) {
    json schema = schema_of<T>();
    // The snow of a part has the scene's snow as its defaults, so the schema states none.
    if constexpr (std::is_same_v<T, material::Snow>)
      for (auto& [name, property] : schema["properties"].items()) property.erase("default");
    add(key, schema, doc);
  }

  template <class T>
  void list(const char* key, std::vector<T>&, const methods::Range& count, const char* doc) {
    add(key,
        {{"type", "array"},
         {"items", schema_of<T>()},
         {"minItems", static_cast<int>(count.min)},
         {"maxItems", static_cast<int>(count.max)}},
        doc, count.need);
  }

  void read_method_first(const char*, methods::MethodChoice&) {}
  /// Every part is described.
  bool shows(const char*, const methods::MethodChoice&, methods::Part part) {
    only_for_methods_with(part);
    return true;
  }
  void only_for_methods_with(methods::Part part) {
    methods_ = json::array();
    for (const methods::MethodDescriptor* method : methods::all_methods())
      if (method->info().takes.has(part)) methods_.push_back(method->info().name);
  }

  void method(const char* key, const char* settings_key, methods::MethodChoice&, const char* doc,
              const char* settings_doc) {
    json names = json::array(), alternatives = json::array();
    for (const methods::MethodDescriptor* method : methods::all_methods()) {
      json schema = {{"title", method->info().name}, {"description", method->info().doc}};
      schema.update(write(definitions_, methods::MethodChoice(*method)));
      names.push_back(method->info().name);
      alternatives.push_back(std::move(schema));
    }
    add(key, {{"enum", names}, {"default", names[0]}}, doc);
    add(settings_key, {{"anyOf", std::move(alternatives)}}, settings_doc);
  }

  void alias(const char* key, const char* other) { aliases_[key].push_back(other); }

  void accuracy(std::initializer_list<const char*> keys) {
    accuracy_.insert(keys.begin(), keys.end());
  }

  void variants(const char* key, std::string&, const char* doc) {
    variant_key_ = key;
    variant_doc_ = doc;
  }

  /// Always true: every kind is described, each in an object of its own.
  bool variant(const char* name, const char* doc) {
    end_variant();
    add(variant_key_.c_str(), {{"const", name}}, variant_doc_, methods::Need::required);
    variant_name_ = name;
    variant_what_ = doc;
    return true;
  }

  void end_variants() { end_variant(); }

 private:
  json finish() {
    if (!variants_.empty()) return {{"oneOf", std::move(variants_)}};
    return closed_object();
  }

  json closed_object() {
    json schema = {{"type", "object"}, {"properties", std::move(properties_)}};
    if (!required_.empty()) schema["required"] = std::move(required_);
    schema["additionalProperties"] = false;
    properties_ = json::object();
    required_ = json::array();
    return schema;
  }

  void end_variant() {
    if (variant_name_.empty()) return;
    json schema = {{"title", variant_name_}, {"description", variant_what_}};
    schema.update(closed_object());
    variants_.push_back(std::move(schema));
  }

  void add(const char* key, const json& schema, std::string doc,
           methods::Need need = methods::Need::optional) {
    if (need == methods::Need::required) required_.push_back(key);
    if (need == methods::Need::required_in_3d) doc += " (required in 3D)";
    json property = {{"description", doc}};
    property.update(schema);
    if (!methods_.empty()) property["x-methods"] = std::move(methods_);
    methods_ = json::array();
    if (accuracy_.count(key)) property["x-accuracy"] = true;
    if (aliases_.count(key)) property["x-aliases"] = aliases_[key];
    properties_[key] = std::move(property);
  }

  static json limited(const char* type, const methods::Range& range, const std::string& unit = "") {
    json schema = {{"type", type}};
    if (std::isfinite(range.min))
      schema[range.open_min ? "exclusiveMinimum" : "minimum"] = range.min;
    if (std::isfinite(range.max))
      schema[range.open_max ? "exclusiveMaximum" : "maximum"] = range.max;
    if (!unit.empty()) schema["x-unit"] = unit;
    return schema;
  }

  static json array(json items, int min_items, const std::string& unit) {
    json schema = {
        {"type", "array"}, {"items", std::move(items)}, {"minItems", min_items}, {"maxItems", 3}};
    if (!unit.empty()) schema["x-unit"] = unit;
    return schema;
  }

  static json entries(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

  static json with_default(json schema, json value, methods::Need need) {
    if (need == methods::Need::optional) schema["default"] = std::move(value);
    return schema;
  }

  template <class T>
  json schema_of() {
    if constexpr (!std::is_same_v<T, ShapeSpec>) {
      return write<T>(definitions_);
    } else {  // shapes hold shapes
      constexpr const char* name = "shape";
      if (!definitions_.contains(name)) {
        definitions_[name] = json::object();  // ends the recursion
        json schema = write<T>(definitions_);
        definitions_[name] = std::move(schema);
      }
      return {{"$ref", std::string("#/$defs/") + name}};
    }
  }

  json& definitions_;
  json properties_ = json::object();
  json required_ = json::array();
  json variants_ = json::array();
  json methods_ = json::array();    // methods that take the next part; empty if all do
  std::set<std::string> accuracy_;  // keys that trade accuracy for time
  // Aliases by the key that they stand for.
  std::map<std::string, std::vector<std::string>> aliases_;
  std::string variant_key_, variant_doc_, variant_name_, variant_what_;
};

}  // namespace snowshed::scene
