// The descriptor of the snow slide.
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/slide/cost.hpp"
#include "snowshed/methods/slide/describe.hpp"
#include "snowshed/methods/slide/input.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed::methods::slide {
namespace {

/// Refuses settings that the mode would ignore.
void check_mode(const Settings& s) {
  const Settings usual;
  const auto check = [&](const char* key, bool is_set, Mode mode) {
    if (is_set && s.mode != mode)
      throw InputError(std::string("/numerics/") + key,
                       std::string("only in the mode \"") + name_of(mode) + "\"");
  };
  check("explicit_friction", s.explicit_friction, Mode::compatible);
  check("artificial_viscosity", s.artificial_viscosity != usual.artificial_viscosity,
        Mode::compatible);
  check("columns", s.columns != usual.columns, Mode::improved);
  check("mixing_rate", s.mixing_rate != usual.mixing_rate, Mode::improved);
  check("ground_rest_time", s.ground_rest_time != usual.ground_rest_time, Mode::improved);
}

/// Refuses changes of the ground that cannot happen, or that AvaFrame would compute otherwise.
void check_ground(const Settings& s, const TerrainSpec& terrain) {
  const auto refuse = [](const char* key, const std::string& why) {
    throw InputError(std::string("/numerics/") + key, why);
  };
  if (s.ground_gains_detrained && !(s.detrainment > 0 && !terrain.resistance.empty()) &&
      s.mode == Mode::improved)
    refuse("ground_gains_detrained",
           "forest takes no snow: give areas of /terrain/resistance and "
           "/numerics/detrainment above 0");
  if (s.ground_loses_entrained && terrain.entrainment.empty() && s.mode == Mode::improved)
    refuse("ground_loses_entrained",
           "the slide takes up no snow: give areas of "
           "/terrain/entrainment");
  if (s.mode == Mode::improved || !s.changes_ground()) return;
  const char* key = s.ground_gains_stopped     ? "ground_gains_stopped"
                    : s.ground_gains_detrained ? "ground_gains_detrained"
                                               : "ground_loses_entrained";
  const char* later = !terrain.secondary_release.empty() ? "secondary releases"
                      : !terrain.inflows.empty()         ? "inflows"
                                                         : nullptr;
  if (later)
    refuse(key, std::string("not with ") + later +
                    " in the mode \"compatible\": their snow would be that of the first ground");
}

void check_inflows(const TerrainSpec& terrain, Mode mode) {
  for (std::size_t i = 0; i < terrain.inflows.size(); ++i)
    if (terrain.inflows[i].bonds && mode == Mode::compatible)
      throw InputError("/terrain/inflows/" + std::to_string(i) + "/bonds",
                       "only in the mode \"improved\"");
}

/// Refuses dams that the mode would change.
void check_dams(const TerrainSpec& terrain, Mode mode) {
  const bool compatible = mode == Mode::compatible;
  if (compatible && terrain.dams.size() > 1)
    throw InputError("/terrain/dams",
                     show(terrain.dams.size()) + " dams; the mode \"compatible\" has at most 1");
  for (std::size_t i = 0; i < terrain.dams.size(); ++i) {
    const DamSpec& dam = terrain.dams[i];
    const std::string path = "/terrain/dams/" + std::to_string(i);
    for (std::size_t k = 1; k < dam.corners.size(); ++k)
      if (dam.corners[k].x == dam.corners[k - 1].x && dam.corners[k].y == dam.corners[k - 1].y)
        throw InputError(path + "/corners/" + std::to_string(k), "is the corner before it");
    if (!compatible && dam.slope != 90)
      throw InputError(path + "/slope", show(dam.slope) +
                                            "; dams are vertical in the mode \"improved\": draw "
                                            "the foot of the face, and leave the slope out");
    if (compatible && dam.restitution != 0 && dam.restitution != 1)
      throw InputError(path + "/restitution",
                       show(dam.restitution) +
                           "; allowed in the mode \"compatible\": 0 and 1 (AvaFrame takes all "
                           "values below 1 as 0)");
  }
}

class Descriptor final : public DescriptorBase<Descriptor, Settings> {
 public:
  const MethodInfo& info() const override {
    static const MethodInfo info{
        "slide",
        "The snow slide: depth-averaged particles with cohesive bonds on terrain",
        {Part::terrain},
        "cells",
        names_of(named_energies(EnergyBalance{})),
        {{"thickness", "m", "Thickness of the snow, normal to the ground", 1, 0.005}}};
    return info;
  }

  std::string step_setting() const override { return "time_step"; }

  void validate(const SceneView& scene) const override {
    if (!scene.terrain) throw InputError("/", "a slide needs a /terrain");
    if (scene.dimension != 3)
      throw InputError("/dimension", "a slide needs three dimensions; allowed: 3");
    if (scene.events.count != 1)
      throw InputError("/events/count", show(scene.events.count) + " events; a slide has 1");
    if (!scene.terrain->thickness_file.empty() && settings_.mode == Mode::compatible &&
        settings_.bonds)
      throw InputError(
          "/numerics/bonds",
          "not with a /terrain/thickness_file in the mode \"compatible\": AvaFrame 2.1 "
          "fails to bond snow of a raster; set bonds to false, or use the mode "
          "\"improved\"");
    check_mode(settings_);
    check_ground(settings_, *scene.terrain);
    check_inflows(*scene.terrain, settings_.mode);
    check_dams(*scene.terrain, settings_.mode);
  }
  std::vector<UnusedSettings> unused_settings(const SceneView& scene) const override {
    return slide::unused_settings(settings_, *scene.terrain);
  }
  std::shared_ptr<const MethodInput> read(const SceneView& scene,
                                          const std::filesystem::path& base_dir) const override {
    return std::make_shared<const Input>(*scene.terrain, settings_, base_dir);
  }
  std::unique_ptr<Method> build(const SceneView& scene,
                                const Surroundings& surroundings) const override {
    const auto& input = dynamic_cast<const Input&>(*surroundings.input);
    Options o;
    o.settings = settings_;
    o.gravity = scene.gravity;
    o.terrain = input.terrain();
    o.areas = input.areas();
    o.energy = scene.output.energy;
    return make_solver(std::move(o));
  }

  CostEstimate cost_of_method(const SceneView& scene, const Surroundings& surroundings,
                              const Method& method) const override {
    const auto& input = dynamic_cast<const Input&>(*surroundings.input);
    return estimate_cost(settings_, scene, input.areas().release.front(),
                         dynamic_cast<const Solver&>(method));
  }
  std::vector<Feature> features(const SceneView& scene, const SceneOutline&) const override {
    return features_of(settings_, scene);
  }
};

}  // namespace

const MethodDescriptor& descriptor() {
  static const Descriptor instance;
  return instance;
}

}  // namespace snowshed::methods::slide
