#include "snowshed/scene/presets.hpp"

#include <functional>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"

namespace snowshed::scene {
namespace {

/// Table 4.3.1; with the density and Poisson's ratio of Table 4.1.1 these are Snow's defaults.
material::Snow calibrated_snow() { return {}; }

/// Reference values of Table 3.2.1 that differ from the calibrated ones. In our copy of the thesis
/// bold type survives only as blanks around a number. It marks M 0.5, xi 0.1 and beta 0.1, and
/// leaves p0 open, for which the middle value is taken. (The thesis's chapter 4 says that only p0
/// changed in the calibration, which would make the reference beta 0.2.)
material::Snow reference_snow() {
  material::Snow snow;
  snow.preconsolidation_pressure = 5.0e3;
  snow.cohesion = 0.1;
  return snow;
}

/// Tables 2.3.1 and 4.1.1. The panel is simulated wider than it was (0.142 m), 1.5 times the
/// slab's width. Table 2.3.1 prints 3 events, sections 2.3 and 4.1 and their figures 5. Contact
/// (separate), the treatment between events (carry) and their end (rest) are ours.
Scene lab_scene(double tilt) {
  Scene scene;
  scene.title = "Laboratory experiment, Tables 2.3.1 and 4.1.1, calibrated snow";
  scene.snow = calibrated_snow();
  Panel& panel = scene.panel.emplace();
  panel.height = 0.33;
  panel.length = 0.245;
  panel.width = 0.213;
  panel.tilt = tilt;
  panel.condition = methods::Condition::separate;
  Slab& slab = scene.slab.emplace();
  slab.thickness = 0.02;  // its length stays 0: as long as the panel, even if that is changed
  slab.width = 0.142;
  scene.ground.emplace().condition = methods::Condition::sticky;
  scene.events.count = 5;
  return scene;
}

/// Table 3.2.1: the laboratory's panel, higher above the ground.
Scene sensitivity_scene() {
  Scene scene = lab_scene(40.0);
  scene.title = "Sensitivity analysis, Table 3.2.1, reference snow";
  scene.snow = reference_snow();
  scene.panel->height = 0.5;
  scene.events.count = 3;
  return scene;
}

/// Table 5.1.1, reference values, in 2D; tilt, conditions, dx and events are the laboratory's.
Scene geometry_scene() {
  Scene scene = lab_scene(40.0);
  scene.title = "Panel geometry, Table 5.1.1, calibrated snow";
  scene.dimension = 2;
  scene.panel->height = 2.0;
  scene.panel->length = 2.0;
  scene.panel->width = 0.0;
  scene.slab->thickness = 0.05;
  scene.slab->width = 0.0;
  return scene;
}

template <class T>
struct Preset {
  const char* name;
  std::function<T()> make;
};

const std::vector<Preset<material::Snow>>& snow_presets() {
  static const std::vector<Preset<material::Snow>> presets = {{"calibrated", calibrated_snow},
                                                              {"reference", reference_snow}};
  return presets;
}

const std::vector<Preset<Scene>>& scene_presets() {
  static const std::vector<Preset<Scene>> presets = {{"lab-40", [] { return lab_scene(40.0); }},
                                                     {"lab-50", [] { return lab_scene(50.0); }},
                                                     {"sensitivity", sensitivity_scene},
                                                     {"geometry", geometry_scene}};
  return presets;
}

template <class T>
std::vector<std::string> names_of(const std::vector<Preset<T>>& presets) {
  std::vector<std::string> names;
  for (const auto& preset : presets) names.push_back(preset.name);
  return names;
}

template <class T>
T make(const std::vector<Preset<T>>& presets, const std::string& name) {
  for (const auto& preset : presets)
    if (preset.name == name) return preset.make();
  const auto names = names_of(presets);
  throw InputError("preset",
                   quote(name) + " is none of " + quoted_list(names) + suggestion(name, names));
}

}  // namespace

material::Snow preset_snow(const std::string& name) { return make(snow_presets(), name); }

Scene preset_scene(const std::string& name) { return make(scene_presets(), name); }

std::vector<std::string> snow_preset_names() { return names_of(snow_presets()); }

std::vector<std::string> scene_preset_names() { return names_of(scene_presets()); }

}  // namespace snowshed::scene
