// Visitor that fills a scene from JSON, and checks each field as it is read.
#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "snowshed/methods/registry.hpp"
#include "snowshed/scene/checker.hpp"
#include "snowshed/scene/json_value.hpp"

namespace snowshed::scene {

class Reader : public Checker {
 public:
  Reader(const nlohmann::json& value, std::string path, const int& dimension)
      : Checker(std::move(path), dimension), object_(value) {
    if (!object_.is_object()) throw wrong_type(shown_path(path_), object_, "an object");
  }

  /// Reads `target` from `value`, an object at `path`.
  template <class T>
  static void read(const nlohmann::json& value, const std::string& path, const int& dimension,
                   T& target) {
    Reader reader(value, path, dimension);
    describe(reader, target);
    reader.finish();
  }

  void version(const char* key, int number, const char*) {
    const json* value = take(key, methods::Need::required, "the version " + std::to_string(number));
    if (value && *value != number)
      throw InputError(at(key), shown(*value) + " is not a version that this program reads (" +
                                    std::to_string(oldest_scene_version) + " to " +
                                    std::to_string(number) + ")");
  }

  void number(const char* key, double& value, const char* unit, const methods::Range& range,
              const char* doc) {
    const std::string allowed = "a number (" + range.in(dimension_).text(unit) + ")";
    if (const json* given = take(key, range.need, allowed)) {
      value = to_number(*given, at(key), allowed);
      Checker::number(key, value, unit, range, doc);
    }
  }

  void number_instead(const char* key, std::optional<double>& value, const char* other,
                      const char* unit, const methods::Range& range, const char* doc) {
    if (object_.contains(key) && object_.contains(other))
      throw InputError(at(key), "takes the place of " + at(other) + "; give one of the two");
    keys_.push_back(key);
    if (object_.contains(other)) value.reset();
    if (object_.contains(key)) number(key, value.emplace(), unit, range, doc);
  }

  template <class Int>
  void integer(const char* key, Int& value, const methods::Range& range, const char* doc) {
    const std::string allowed = "a whole number (" + range.text() + ")";
    if (const json* given = take(key, range.need, allowed)) {
      value = to_integer<Int>(*given, at(key), range, allowed);
      Checker::integer(key, value, range, doc);
    }
  }

  void flag(const char* key, bool& value, const char*) {
    if (const json* given = take(key)) value = to_flag(*given, at(key));
  }

  void text(const char* key, std::string& value, const char* doc) {
    if (const json* given = take(key)) {
      value = to_text(*given, at(key));
      Checker::text(key, value, doc);
    }
  }

  void file(const char* key, std::string& value, const char* doc) {
    if (const json* given = take(key, methods::Need::required, "a file name")) {
      value = to_text(*given, at(key));
      Checker::file(key, value, doc);
    }
  }

  void choice(const char* key, const methods::Choice& value, const char*) {
    if (const json* given = take(key)) value.choose(to_index(*given, at(key), value.names()));
  }

  void vector(const char* key, Vec3& value, const char* unit, const methods::Range& range,
              const char* doc) {
    if (const json* given = take(key, range.need, vector_text(dimension_))) {
      value = to_vector(*given, at(key), dimension_);
      Checker::vector(key, value, unit, range, doc);
    }
  }

  void direction(const char* key, Vec3& value, const char* doc) {
    if (const json* given = take(key)) {
      value = to_vector(*given, at(key), dimension_);
      Checker::direction(key, value, doc);
    }
  }

  void axis(const char* key, Vec3& value, const char* doc) {
    if (dimension_ == 3) direction(key, value, doc);
  }

  void spin(const char* key, Vec3& value, const char* unit, const methods::Range& range,
            const char* doc) {
    if (dimension_ == 3) {
      vector(key, value, unit, range, doc);
    } else if (const json* given = take(key)) {
      value = {0.0, to_number(*given, at(key), "a number (about +y, in 2D)"), 0.0};
      Checker::spin(key, value, unit, range, doc);
    }
  }

  void outline(const char* key, geometry::Ring& ring, const char* doc) {
    if (const json* given = take(key, methods::Need::required, "an array of corners [x, y]")) {
      ring = to_ring(*given, at(key));
      Checker::outline(key, ring, doc);
    }
  }

  template <class T>
  void object(const char* key, T& value, methods::Need need, const char*) {
    if (const json* given = take(key, need, "an object")) read(*given, at(key), dimension_, value);
  }

  template <class T>
  void optional(const char* key, std::optional<T>& value, const char*) {
    if (const json* given = take(key)) read(*given, at(key), dimension_, value.emplace());
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const methods::Range& count, const char*) {
    const json* given = take(key, count.need, "an array");
    if (!given) return;
    if (!given->is_array()) throw wrong_type(at(key), *given, "an array");
    check_count(at(key), given->size(), count);
    items.assign(given->size(), T{});
    for (std::size_t i = 0; i < items.size(); ++i)
      read((*given)[i], at(key) + "/" + std::to_string(i), dimension_, items[i]);
  }

  void read_method_first(const char* key, methods::MethodChoice& method) {
    const auto given = object_.find(key);
    if (given != object_.end())
      method = methods::MethodChoice(
          *methods::all_methods()[to_index(*given, at(key), methods::method_names())]);
  }

  void method(const char* key, const char* settings_key, methods::MethodChoice& method, const char*,
              const char* settings_doc) {
    take(key);  // read ahead
    object(settings_key, method, methods::Need::optional, settings_doc);
  }

  bool shows(const char* key, const methods::MethodChoice& method, methods::Part part) {
    if (!method.takes(part)) foreign_[key] = methods::takes_no_part(method->info(), part);
    return method.takes(part);
  }

  void alias(const char* key, const char* other) {
    aliases_.push_back(other);
    if (!object_.contains(other)) return;
    if (object_.contains(key))
      throw InputError(at(other), "means the same as " + at(key) + "; give one of the two");
    given_alias_[key] = other;
  }

  void variants(const char* key, std::string& type, const char* doc) {
    const json* given = take(key, methods::Need::required, "a text");
    if (!given) throw *missing_;  // without it no other key makes sense
    type = to_text(*given, at(key));
    Checker::variants(key, type, doc);
  }

 private:
  using json = nlohmann::json;

  /// The value of `key`, or null if it is absent. A missing required key is reported only in
  /// `finish`, after unknown ones: a misspelt key is both, and naming the misspelling helps more.
  const json* take(const char* key, methods::Need need = methods::Need::optional,
                   const std::string& allowed = "") {
    keys_.push_back(key);
    const auto alias = given_alias_.find(key);
    const auto member = object_.find(alias == given_alias_.end() ? key : alias->second);
    if (member != object_.end()) return &*member;
    if (methods::is_required(need, dimension_) && !missing_)
      missing_ = InputError(at(key), "missing: " + allowed + " is required");
    return nullptr;
  }

  void finish() const {
    std::vector<std::string> known = keys_;
    known.insert(known.end(), aliases_.begin(), aliases_.end());
    for (const auto& [key, value] : object_.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      if (const auto foreign = foreign_.find(key); foreign != foreign_.end())
        throw InputError(at(key), foreign->second);
      const std::string near = suggestion(key, known);
      throw InputError(at(key),
                       "unknown key" + (near.empty() ? "; allowed: " + quoted_list(keys_) : near));
    }
    if (missing_) throw *missing_;
  }

  const json& object_;
  std::vector<std::string> keys_;
  std::vector<std::string> aliases_;
  std::map<std::string, std::string> given_alias_;  // alias by the key that it stands for
  std::map<std::string, std::string> foreign_;      // errors at parts of other methods, by key
  std::optional<InputError> missing_;
};

}  // namespace snowshed::scene
