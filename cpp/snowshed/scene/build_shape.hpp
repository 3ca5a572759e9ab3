// Solids from their descriptions in a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Largest depth to which unions, differences and transforms may nest.
inline constexpr int max_shape_depth = 32;

/// The solid that `spec` describes, for a scene of `dimension` 2 or 3. Files are sought
/// relative to `base_dir`. In 2D boxes and plates are unbounded along y, and every point and
/// direction must lie in the plane y = 0.
///
/// Changes and assumptions about files are added to `notes`, if given, a sentence each.
///
/// Throws InputError with the JSON path (`json_path` + "/radius") of a bad value, or with
/// the file and the position in it of bad mesh or grid data.
geometry::Shape build_shape(const ShapeSpec& spec, int dimension, const std::string& json_path,
                            const std::filesystem::path& base_dir,
                            std::vector<std::string>* notes = nullptr);

}  // namespace snowshed::scene
