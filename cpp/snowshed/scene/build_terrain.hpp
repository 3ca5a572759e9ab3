// From a scene's terrain to the grid and the areas of a slide.
#pragma once

#include <filesystem>

#include "snowshed/geometry/height_field.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Reads the raster and brings it onto the computing grid. In compatible mode elevations are
/// rounded to single precision, as AvaFrame reads them. Throws InputError.
HeightField build_height_field(const TerrainSpec& terrain, const SlideSettings& settings,
                               const std::filesystem::path& base_dir);

/// The areas, from the south-west node of the grid. Throws InputError where the raster of thickness
/// is none.
SlideAreas build_areas(const TerrainSpec& terrain, const HeightField& field,
                       const std::filesystem::path& base_dir);

}  // namespace snowshed
