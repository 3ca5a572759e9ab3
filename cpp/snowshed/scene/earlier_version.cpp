#include "snowshed/scene/earlier_version.hpp"

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {
namespace {

using nlohmann::json;

/// The objects of a scene that have a contact condition, by their JSON pointers.
std::vector<json::json_pointer> parts_with_condition(const json& scene) {
  std::vector<json::json_pointer> parts{json::json_pointer("/panel"),
                                        json::json_pointer("/ground")};
  if (scene.contains("obstacles") && scene["obstacles"].is_array())
    for (std::size_t i = 0; i < scene["obstacles"].size(); ++i)
      parts.push_back(json::json_pointer("/obstacles") / i);
  return parts;
}

/// Renames the condition `slip` of version 1, which released snow as `separate` does now.
void rename_slip(json& scene, std::vector<std::string>& notes) {
  for (const json::json_pointer& part : parts_with_condition(scene)) {
    const json::json_pointer condition = part / "condition";
    if (!scene.contains(condition) || scene[condition] != "slip") continue;
    scene[condition] = "separate";
    notes.push_back(condition.to_string() +
                    ": \"slip\" of version 1 is read as \"separate\", its name since version 2; "
                    "there \"slip\" holds snow on the surface except at its edge");
  }
}

}  // namespace

std::vector<std::string> update_version(json& scene) {
  std::vector<std::string> notes;
  if (!scene.is_object() || !scene.contains("snowshed") || scene["snowshed"] != 1) return notes;
  rename_slip(scene, notes);
  scene["snowshed"] = 2;
  return notes;
}

}  // namespace snowshed::scene
