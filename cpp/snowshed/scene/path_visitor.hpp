// Base of the visitors that need paths in a scene: it keeps the path of the visited object, and
// visits the objects in it.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/scene/describe.hpp"

namespace snowshed::scene {

/// The path as messages show it: "/" for the document itself, whose path is empty.
inline std::string shown_path(const std::string& path) { return path.empty() ? "/" : path; }

/// `Self` is the visitor. A copy of it visits each nested object.
template <class Self>
class PathVisitor {
 public:
  /// `dimension` is a reference, because a reader learns it from the scene it reads.
  PathVisitor(std::string path, const int& dimension)
      : path_(std::move(path)), dimension_(dimension) {}

  template <class T>
  void object(const char* key, T& value, methods::Need, const char*) {
    visit(at(key), value);
  }

  template <class T>
  void optional(const char* key, std::optional<T>& value, const char*) {
    if (value) visit(at(key), *value);
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const methods::Range&, const char*) {
    for (std::size_t i = 0; i < items.size(); ++i)
      visit(pointer(at(key), std::to_string(i)), items[i]);
  }

  void read_method_first(const char*, methods::MethodChoice&) {}
  bool shows(const char*, const methods::MethodChoice& method, methods::Part part) const {
    return method.takes(part);
  }
  void only_for_methods_with(methods::Part) {}

  void method(const char*, const char* settings_key, methods::MethodChoice& method, const char*,
              const char*) {
    visit(at(settings_key), method);
  }

  void alias(const char*, const char*) {}
  void accuracy(std::initializer_list<const char*>) {}

  void variants(const char* key, std::string& type, const char*) {
    variant_key_ = key;
    type_ = type;
    known_types_.clear();
  }

  bool variant(const char* name, const char*) {
    known_types_.push_back(name);
    return type_ == name;
  }

  void end_variants() {
    for (const auto& known : known_types_)
      if (known == type_) return;
    throw InputError(at(variant_key_), quote(type_) + " is none of " + quoted_list(known_types_) +
                                           suggestion(type_, known_types_));
  }

 protected:
  std::string at(const std::string& key) const { return pointer(path_, key); }

  template <class T>
  void visit(const std::string& path, T& value) {
    Self child = static_cast<Self&>(*this);
    child.path_ = path;
    describe(child, value);
  }

  std::string path_;
  const int& dimension_;

 private:
  std::string variant_key_, type_;
  std::vector<std::string> known_types_;
};

}  // namespace snowshed::scene
