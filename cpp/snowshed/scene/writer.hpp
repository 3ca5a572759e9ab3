// Visitor that writes a scene as JSON, every field of it.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>

#include "snowshed/scene/describe.hpp"

namespace snowshed::scene {

class Writer {
 public:
  explicit Writer(int dimension) : dimension_(dimension) {}

  template <class T>
  static nlohmann::ordered_json write(T& object, int dimension) {
    Writer writer(dimension);
    describe(writer, object);
    return std::move(writer.json_);
  }

  void version(const char* key, int number, const char*) { json_[key] = number; }
  void number(const char* key, double& value, const char*, const methods::Range&, const char*) {
    json_[key] = value;
  }
  void number_instead(const char* key, std::optional<double>& value, const char* other, const char*,
                      const methods::Range&, const char*) {
    if (!value) return;
    json_.erase(other);
    json_[key] = *value;
  }
  template <class Int>
  void integer(const char* key, Int& value, const methods::Range&, const char*) {
    json_[key] = value;
  }
  void flag(const char* key, bool& value, const char*) { json_[key] = value; }
  void text(const char* key, std::string& value, const char*) { json_[key] = value; }
  void file(const char* key, std::string& value, const char*) { json_[key] = value; }
  void choice(const char* key, const methods::Choice& value, const char*) {
    json_[key] = value.name();
  }

  void vector(const char* key, Vec3& v, const char*, const methods::Range&, const char*) {
    put(key, v);
  }
  void direction(const char* key, Vec3& v, const char*) { put(key, v); }
  void axis(const char* key, Vec3& v, const char*) {
    if (dimension_ == 3) put(key, v);
  }
  void spin(const char* key, Vec3& v, const char*, const methods::Range&, const char*) {
    if (dimension_ == 3)
      put(key, v);
    else
      json_[key] = v.y();
  }

  void outline(const char* key, geometry::Ring& ring, const char*) {
    auto& corners = json_[key] = nlohmann::ordered_json::array();
    for (const geometry::Point2& p : ring) corners.push_back({p[0], p[1]});
  }

  template <class T>
  void object(const char* key, T& value, methods::Need, const char*) {
    json_[key] = write(value, dimension_);
  }
  template <class T>
  void optional(const char* key, std::optional<T>& value, const char*) {
    if (value) json_[key] = write(*value, dimension_);
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, const methods::Range&, const char*) {
    auto& array = json_[key] = nlohmann::ordered_json::array();
    for (auto& item : items) array.push_back(write(item, dimension_));
  }

  void read_method_first(const char*, methods::MethodChoice&) {}
  bool shows(const char*, const methods::MethodChoice& method, methods::Part part) const {
    return method.takes(part);
  }
  void only_for_methods_with(methods::Part) {}

  /// Leaves out the default method: its scenes and their hashes equal those of versions without a
  /// choice of method.
  void method(const char* key, const char* settings_key, methods::MethodChoice& method, const char*,
              const char*) {
    if (!method.is_default()) json_[key] = method->info().name;
    json_[settings_key] = write(method, dimension_);
  }

  void alias(const char*, const char*) {}
  void accuracy(std::initializer_list<const char*>) {}

  void variants(const char* key, std::string& type, const char*) { json_[key] = type_ = type; }
  bool variant(const char* name, const char*) { return type_ == name; }
  void end_variants() {}

 private:
  void put(const char* key, const Vec3& v) {
    if (dimension_ == 2)
      json_[key] = {v.x(), v.z()};
    else
      json_[key] = {v.x(), v.y(), v.z()};
  }

  int dimension_;
  std::string type_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

}  // namespace snowshed::scene
