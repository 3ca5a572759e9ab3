// The JSON form of a scene: reading, checking, writing, and its published schema.
// Every field is described once, in scene/describe.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Reads and validates a scene. Missing values of a layer's or a body's snow are those of the
/// scene's snow. Throws InputError whose `where` is the JSON pointer of the offending value
/// ("/snow/density", "/" for the scene itself), or "name:line:column" when the text is not JSON.
/// The record of a run (run.json) stands for the scene in it. In names of files, a leading "~" is
/// the user's home.
/// The text need not be trusted: its size, depth and number of values are limited. `notes` (if any)
/// gets the new names of fields in a scene of an earlier version.
Scene parse_scene(const std::string& text, const std::string& name = "scene",
                  std::vector<std::string>* notes = nullptr);

/// The scene with absolute names of mesh and grid files; relative ones refer to `folder`.
Scene with_absolute_files(const std::filesystem::path& folder, Scene scene);

/// The mesh and grid files that the shapes of a scene name, as they are written there, without
/// repetition.
std::vector<std::string> shape_files(const Scene& scene);

/// All files that a scene names, as they are written there, without repetition.
std::vector<std::string> input_files(const Scene& scene);

/// `parse_scene` on a file; errors name it. Mesh and grid files given by a relative path are
/// looked for beside the scene file, so the result does not depend on the working directory.
Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);

/// The complete JSON of a valid scene, defaults included: parse_scene gives back the same scene.
/// A shape has only the fields that its type uses, and in 2D only x and z of a vector.
std::string write_scene(const Scene& scene);

/// The same scene with the threads and the device of another.
Scene with_machine_of(const Scene& other, Scene scene);

/// Settings that say with what a machine computes, by their keys: a run may be resumed with others.
inline constexpr const char* settings_of_machines[] = {"threads", "device"};

/// A checksum of the values in the text of a scene without `settings_of_machines`. It depends
/// neither on the order of keys nor on keys that a later version of the program adds.
std::string scene_checksum(const std::string& text);

/// The complete JSON of a snow.
std::string write_snow(const material::Snow& snow);

/// JSON Schema (2020-12) of the form; units stand under "x-unit". Rules between several fields
/// are beyond a schema: `validate` has them.
std::string scene_schema();

/// Throws InputError at the first field that is out of range or contradicts another.
void validate(const Scene& scene);

/// Replaces the zeros that stand for "follow another field": the slab's length and width (from
/// the panel) and the particles per voxel (from the dimension).
Scene resolve(Scene scene);

}  // namespace snowshed::scene
