#include "snowshed/scene/scene_json.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "snowshed/io/checksum.hpp"
#include "snowshed/io/home_folder.hpp"
#include "snowshed/scene/earlier_version.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/reader.hpp"
#include "snowshed/scene/validation.hpp"
#include "snowshed/scene/writer.hpp"

namespace snowshed::scene {
namespace {

/// Reads at most one byte more than is allowed, even from an endless file.
std::string read_text(const std::filesystem::path& file) {
  std::error_code failed;
  const auto status = std::filesystem::status(file, failed);
  if (status.type() == std::filesystem::file_type::not_found)
    throw InputError(file.string(), "no such file");
  if (failed) throw InputError(file.string(), "cannot be read: " + failed.message());
  if (std::filesystem::is_directory(status)) throw InputError(file.string(), "is a folder");
  if (std::filesystem::is_fifo(status) || std::filesystem::is_socket(status))  // they could block
    throw InputError(file.string(), "not a regular file");
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  char block[1 << 16];
  while (stream && text.size() <= max_text_bytes) {
    stream.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof() && text.size() <= max_text_bytes)
    throw InputError(file.string(), "cannot be read");
  return text;
}

template <class Change>
void change_files(ShapeSpec& shape, const Change& change) {
  change(shape.file);
  for (auto& part : shape.shapes) change_files(part, change);
}

/// Calls `change` with the name of every file; names may be empty.
template <class Change>
void change_files(Scene& scene, const Change& change) {
  for (auto& obstacle : scene.obstacles) change_files(obstacle.shape, change);
  for (auto& body : scene.bodies) change_files(body.shape, change);
  if (scene.terrain)
    for (std::string* file : {&scene.terrain->file, &scene.terrain->thickness_file}) change(*file);
  if (scene.sample) change(scene.sample->file);
}

void add_files(const ShapeSpec& shape, std::vector<std::string>& files) {
  const bool known = std::find(files.begin(), files.end(), shape.file) != files.end();
  if (!shape.file.empty() && !known) files.push_back(shape.file);
  for (const auto& part : shape.shapes) add_files(part, files);
}

/// Returns a positive number of a snow, or what it is unless given; wrong values are refused later.
double given_or(const nlohmann::json& snow, const char* key, double usual) {
  const auto entry = snow.find(key);
  if (entry == snow.end() || !entry->is_number()) return usual;
  const double value = entry->get<double>();
  return value > 0 ? value : usual;
}

/// Scales stiffness and strength that the scene's snow gives to the density of a part's own snow.
void scale_to_density(const nlohmann::json& own, nlohmann::json& complete) {
  const material::Snow usual;
  const double before = given_or(complete, "density", usual.density);
  material::Snow scaled;
  scaled.density = given_or(own, "density", before);
  scaled.youngs_modulus = given_or(complete, "youngs_modulus", usual.youngs_modulus);
  scaled.preconsolidation_pressure =
      given_or(complete, "preconsolidation_pressure", usual.preconsolidation_pressure);
  if (scaled.density == before) return;
  scaled.scale_from_density(before);
  for (const auto& [key, value] :
       {std::pair{"youngs_modulus", scaled.youngs_modulus},
        std::pair{"preconsolidation_pressure", scaled.preconsolidation_pressure}})
    if (complete.contains(key) && complete[key].is_number()) complete[key] = value;
}

/// Adds the values that the snow of a layer or body lacks from the scene's snow, both as given.
void complete_snow(const nlohmann::json& of_scene, nlohmann::json& part) {
  if (!part.is_object() || !part.contains("snow") || !part["snow"].is_object()) return;
  nlohmann::json complete = of_scene;
  scale_to_density(part["snow"], complete);
  complete.update(part["snow"]);
  part["snow"] = std::move(complete);
}

void complete_snow(nlohmann::json& scene) {
  if (!scene.is_object() || !scene.contains("snow") || !scene["snow"].is_object()) return;
  const nlohmann::json of_scene = scene["snow"];
  for (const char* list : {"/slab/layers", "/bodies"}) {
    const nlohmann::json::json_pointer pointer(list);
    if (!scene.contains(pointer) || !scene[pointer].is_array()) continue;
    for (auto& part : scene[pointer]) complete_snow(of_scene, part);
  }
}

/// Takes the scene out of the record of a run (run.json); any other document stays as it is.
void take_scene_of_record(nlohmann::json& document) {
  if (!document.is_object() || document.contains("snowshed")) return;
  if (!document.contains("scene") || !document["scene"].is_object()) return;
  nlohmann::json scene = std::move(document["scene"]);
  document = std::move(scene);
}

InputError with_file_name(const InputError& error, const std::string& file) {
  if (error.where().rfind(file, 0) == 0) return error;
  const std::string message = error.what();
  return InputError(error.where(), message.substr(error.where().size() + 2) + " [in " + file + "]");
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name,
                  std::vector<std::string>* notes) {
  Scene scene;
  nlohmann::json json = parse_json(text, name);
  take_scene_of_record(json);
  const std::vector<std::string> changed = update_version(json);
  if (notes) notes->insert(notes->end(), changed.begin(), changed.end());
  complete_snow(json);
  Reader::read(json, "", scene.dimension, scene);
  change_files(scene, [](std::string& file) { file = io::with_home(file); });
  check_rules(scene);
  return scene;
}

Scene with_absolute_files(const std::filesystem::path& folder, Scene scene) {
  const auto absolute = std::filesystem::absolute(folder.empty() ? "." : folder);
  change_files(scene, [&](std::string& file) {
    if (!file.empty()) file = (absolute / file).lexically_normal().string();
  });
  return scene;
}

std::vector<std::string> shape_files(const Scene& scene) {
  std::vector<std::string> files;
  for (const auto& obstacle : scene.obstacles) add_files(obstacle.shape, files);
  for (const auto& body : scene.bodies) add_files(body.shape, files);
  return files;
}

std::vector<std::string> input_files(const Scene& scene) {
  std::vector<std::string> files = shape_files(scene);
  if (scene.terrain)
    for (const std::string& file : {scene.terrain->file, scene.terrain->thickness_file})
      if (!file.empty()) files.push_back(file);
  if (scene.sample) files.push_back(scene.sample->file);
  return files;
}

Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* notes) {
  try {
    return with_absolute_files(file.parent_path(),
                               parse_scene(read_text(file), file.string(), notes));
  } catch (const InputError& error) {
    throw with_file_name(error, file.string());
  }
}

std::string write_scene(const Scene& scene) {
  validate(scene);
  Scene copy = scene;  // visitors see members they may write to
  return indented_text(Writer::write(copy, copy.dimension));
}

Scene with_machine_of(const Scene& other, Scene scene) {
  scene.numerics->adopt_machine(*other.numerics.operator->());
  return scene;
}

std::string scene_checksum(const std::string& text) {
  nlohmann::json json = parse_json(text, "scene");
  if (json.is_object() && json.contains("numerics") && json["numerics"].is_object())
    for (const char* setting : settings_of_machines) json["numerics"].erase(setting);
  const std::string values = json.dump();
  io::Crc32 sum;
  sum.update(values.data(), values.size());
  return io::hexadecimal(sum.value());
}

std::string write_snow(const material::Snow& snow) {
  material::Snow copy = snow;
  return indented_text(Writer::write(copy, 3));
}

void validate(const Scene& scene) {
  Scene copy = scene;
  Checker checker("", copy.dimension);
  describe(checker, copy);
  check_rules(scene);
}

Scene resolve(Scene scene) {
  if (scene.slab && scene.panel) {
    if (scene.slab->length == 0.0) scene.slab->length = scene.panel->length;
    // Snow must not spill over the sides: the panel is 1.5 times as wide (Table 3.2.1).
    if (scene.slab->width == 0.0) scene.slab->width = scene.panel->width * 2.0 / 3.0;
  }
  if (scene.seeding.particles_per_voxel == 0.0)
    scene.seeding.particles_per_voxel = scene.dimension == 2 ? 6.0 : 8.0;
  return scene;
}

}  // namespace snowshed::scene
