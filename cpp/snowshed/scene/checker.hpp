// Visitor that checks that every field of a scene lies in its range.
#pragma once

#include <cmath>

#include "snowshed/scene/path_visitor.hpp"

namespace snowshed::scene {

class Checker : public PathVisitor<Checker> {
 public:
  using PathVisitor::PathVisitor;

  void version(const char*, int, const char*) {}

  void number(const char* key, double& value, const char* unit, const methods::Range& range,
              const char*) {
    check(at(key), value, range.in(dimension_), unit);
  }

  void number_instead(const char* key, std::optional<double>& value, const char*, const char* unit,
                      const methods::Range& range, const char* doc) {
    if (value) number(key, *value, unit, range, doc);
  }

  template <class Int>
  void integer(const char* key, Int& value, const methods::Range& range, const char*) {
    check(at(key), static_cast<double>(value), range);
  }

  void flag(const char*, bool&, const char*) {}

  void text(const char* key, std::string& value, const char*) {
    if (!is_utf8(value)) throw InputError(at(key), quote(value) + " is not valid UTF-8");
  }

  void file(const char* key, std::string& value, const char* doc) {
    text(key, value, doc);
    if (value.empty() || value.find('\0') != std::string::npos)
      throw InputError(at(key), quote(value) + " is not the name of a file");
  }

  void choice(const char* key, const methods::Choice& value, const char*) {
    if (!value.name())
      throw InputError(at(key), std::to_string(value.number()) + " is not a known choice");
  }

  void vector(const char* key, Vec3& value, const char* unit, const methods::Range& range,
              const char*) {
    if (dimension_ == 2) {
      check(at(key) + "/0", value.x(), range, unit);
      check(at(key) + "/1", value.z(), range, unit);
    } else {
      for (int i = 0; i < 3; ++i) check(at(key) + "/" + std::to_string(i), value[i], range, unit);
    }
  }

  void direction(const char* key, Vec3& value, const char* doc) {
    vector(key, value, "", methods::between(-1e6, 1e6), doc);
    const double length = dimension_ == 2 ? std::hypot(value.x(), value.z()) : value.norm();
    // Shorter vectors lose their direction to rounding when squared.
    constexpr double min_length = 1e-100;
    if (length < min_length) throw InputError(at(key), "a direction must not be zero");
  }

  void axis(const char* key, Vec3& value, const char* doc) {
    if (dimension_ == 3) direction(key, value, doc);
  }

  void spin(const char* key, Vec3& value, const char* unit, const methods::Range& range,
            const char* doc) {
    if (dimension_ == 3)
      vector(key, value, unit, range, doc);
    else
      check(at(key), value.y(), range, unit);
  }

  void outline(const char* key, geometry::Ring& ring, const char*) {
    constexpr std::size_t max_corners = 100000;
    if (ring.size() < 3 || ring.size() > max_corners)
      throw InputError(at(key), std::to_string(ring.size()) + " corners; allowed: 3 to " +
                                    std::to_string(max_corners));
    for (std::size_t i = 0; i < ring.size(); ++i)
      for (const int axis : {0, 1})
        check(at(key) + "/" + std::to_string(i) + "/" + std::to_string(axis), ring[i][axis],
              methods::allowed::map_coordinate, "m");
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const methods::Range& count, const char* doc) {
    check_count(at(key), items.size(), count);
    PathVisitor::list(key, items, count, doc);
  }

 protected:
  static void check(const std::string& path, double value, const methods::Range& range,
                    const std::string& unit = "") {
    if (!range.contains(value))
      throw InputError(path,
                       show(value) + " is outside the allowed range (" + range.text(unit) + ")");
  }

  static void check_count(const std::string& path, std::size_t size, const methods::Range& count) {
    if (!count.contains(static_cast<double>(size)))
      throw InputError(path, std::to_string(size) + " entries are outside the allowed number (" +
                                 count.text() + ")");
  }
};

}  // namespace snowshed::scene
