// Input of a slide from files: its terrain, and the areas on it.
#pragma once

#include <filesystem>

#include "snowshed/geometry/height_field.hpp"
#include "snowshed/methods/scene_parts.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/surroundings.hpp"

namespace snowshed::methods::slide {

class Input final : public MethodInput {
 public:
  /// Reads the raster and resamples it to the computing grid. In compatible mode elevations are
  /// rounded to single precision, as AvaFrame reads them. Throws InputError.
  Input(const TerrainSpec&, const Settings&, const std::filesystem::path& base_dir);

  const char* section() const override { return "ground"; }
  std::vector<FileFingerprint> files() const override;

  const geometry::HeightField& terrain() const { return terrain_; }
  const Areas& areas() const { return areas_; }

 private:
  std::string file_, thickness_file_;
  geometry::HeightField terrain_;
  Areas areas_;  // from the terrain's south-west node
};

}  // namespace snowshed::methods::slide
