#include "snowshed/scene/json_value.hpp"

namespace snowshed::scene {

using nlohmann::json;

std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array";
  if (value.is_string()) return quote(value.get_ref<const std::string&>());
  if (value.is_number_float()) return show(value.get<double>());
  return value.dump();
}

InputError wrong_type(const std::string& path, const json& value, const std::string& allowed) {
  return InputError(path, shown(value) + " is not " + allowed);
}

double to_number(const json& value, const std::string& path, const std::string& allowed) {
  if (!value.is_number()) throw wrong_type(path, value, allowed);
  return value.get<double>();
}

bool to_flag(const json& value, const std::string& path) {
  if (!value.is_boolean()) throw wrong_type(path, value, "true or false");
  return value.get<bool>();
}

std::string to_text(const json& value, const std::string& path) {
  if (!value.is_string()) throw wrong_type(path, value, "a text");
  return value.get<std::string>();
}

std::size_t to_index(const json& value, const std::string& path,
                     const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (value == names[i]) return i;
  const std::string near = value.is_string() ? suggestion(value.get<std::string>(), names) : "";
  throw InputError(path, shown(value) + " is none of " + quoted_list(names) + near);
}

std::string vector_text(int dimension) {
  return dimension == 2 ? "an array of 2 numbers (x, z; the scene is 2D)"
                        : "an array of 3 numbers (x, y, z; the scene is 3D)";
}

Vec3 to_vector(const json& value, const std::string& path, int dimension) {
  if (!value.is_array()) throw wrong_type(path, value, vector_text(dimension));
  if (value.size() != static_cast<std::size_t>(dimension))
    throw InputError(
        path, "an array of " + std::to_string(value.size()) + " is not " + vector_text(dimension));
  const auto entry = [&](int i) {
    return to_number(value[i], path + "/" + std::to_string(i), "a number");
  };
  if (dimension == 2) return {entry(0), 0.0, entry(1)};
  return {entry(0), entry(1), entry(2)};
}

geometry::Ring to_ring(const json& value, const std::string& path) {
  if (!value.is_array()) throw wrong_type(path, value, "an array of corners [x, y]");
  geometry::Ring ring;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string corner = path + "/" + std::to_string(i);
    if (!value[i].is_array() || value[i].size() != 2)
      throw wrong_type(corner, value[i], "a corner [x, y]");
    ring.push_back({to_number(value[i][0], corner + "/0", "a number"),
                    to_number(value[i][1], corner + "/1", "a number")});
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();  // closed explicitly
  return ring;
}

}  // namespace snowshed::scene
