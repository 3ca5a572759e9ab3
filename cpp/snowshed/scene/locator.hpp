// The JSON path of a member of a scene: rules name members, messages name their paths.
#pragma once

#include <typeindex>

#include "snowshed/scene/path_visitor.hpp"

namespace snowshed::scene {

/// Visitor that finds the path of the object with a given address and type.
class Locator : public PathVisitor<Locator> {
 public:
  /// Writes the JSON pointer of the target to `path`.
  Locator(const void* target, std::type_index type, const int& dimension, std::string& path)
      : PathVisitor("", dimension), target_(target), type_(type), result_(path) {}

  template <class T, class... Rest>
  void number(const char* key, T& value, const Rest&...) {
    compare(at(key), value);
  }
  template <class... Rest>
  void number_instead(const char* key, std::optional<double>& value, const Rest&...) {
    compare(at(key), value);
  }
  template <class T, class... Rest>
  void integer(const char* key, T& value, const Rest&...) {
    compare(at(key), value);
  }
  template <class T, class... Rest>
  void vector(const char* key, T& value, const Rest&...) {
    compare(at(key), value);
  }
  template <class T, class... Rest>
  void spin(const char* key, T& value, const Rest&...) {
    compare(at(key), value);
  }
  void version(const char*, int, const char*) {}
  void flag(const char* key, bool& value, const char*) { compare(at(key), value); }
  void text(const char* key, std::string& value, const char*) { compare(at(key), value); }
  void file(const char* key, std::string& value, const char*) { compare(at(key), value); }
  void choice(const char* key, const methods::Choice& value, const char*) {
    if (value.is_at(target_, type_)) result_ = at(key);
  }
  void direction(const char* key, Vec3& value, const char*) { compare(at(key), value); }
  void outline(const char* key, geometry::Ring& ring, const char*) { compare(at(key), ring); }
  void axis(const char* key, Vec3& value, const char*) { compare(at(key), value); }

  template <class T>
  void object(const char* key, T& value, methods::Need need, const char* doc) {
    compare(at(key), value);
    PathVisitor::object(key, value, need, doc);
  }
  template <class T>
  void optional(const char* key, std::optional<T>& value, const char* doc) {
    compare(at(key), value);
    if (value) compare(at(key), *value);
    PathVisitor::optional(key, value, doc);
  }
  void method(const char* key, const char* settings_key, methods::MethodChoice& method,
              const char* doc, const char* settings_doc) {
    compare(at(settings_key), method);
    PathVisitor::method(key, settings_key, method, doc, settings_doc);
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, const methods::Range& count, const char* doc) {
    compare(at(key), items);
    for (std::size_t i = 0; i < items.size(); ++i)
      compare(pointer(at(key), std::to_string(i)), items[i]);
    PathVisitor::list(key, items, count, doc);
  }

 private:
  /// Compares types too, because a struct and its first member share an address.
  template <class T>
  void compare(const std::string& path, const T& value) {
    if (&value == target_ && type_ == typeid(T)) result_ = path;
  }

  const void* target_;
  std::type_index type_;
  std::string& result_;
};

/// Returns the JSON pointer of a member of the scene, "/" for the scene itself.
template <class T>
std::string path_of(const Scene& scene, const T& member) {
  std::string path = "/";
  Locator locator(&member, typeid(T), scene.dimension, path);
  describe(locator, const_cast<Scene&>(scene));  // other visitors may write; this one does not
  return path;
}

}  // namespace snowshed::scene
