// The thesis's parameter sets, each constant once, with the table it comes from.
#pragma once

#include <string>
#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// "calibrated" (Table 4.3.1) or "reference" (Table 3.2.1). Throws InputError on other names.
material::Snow preset_snow(const std::string& name);

/// "lab-40" and "lab-50" (Tables 2.3.1 and 4.1.1), "sensitivity" (Table 3.2.1) or "geometry"
/// (Table 5.1.1, reference values). Throws InputError on other names.
///
/// The thesis prints no coefficient of friction for the panel: all take Panel's default.
Scene preset_scene(const std::string& name);

std::vector<std::string> snow_preset_names();
std::vector<std::string> scene_preset_names();

}  // namespace snowshed::scene
