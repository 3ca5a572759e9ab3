// Grains, as the rest of the program knows them.
#include <algorithm>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/grains/cost.hpp"
#include "snowshed/methods/grains/describe.hpp"
#include "snowshed/methods/grains/input.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::grains {
namespace {

void check_stage(const LoadingStage& stage, const std::string& path, const Settings& settings) {
  const std::string kind = quote(name_of(stage.kind));
  if (stage.kind == LoadingKind::stretch && !settings.bonded_plates)
    throw InputError(path + "/kind", kind + " pulls at the plates; set /numerics/bonded_plates");
  const bool takes_stress = stage.kind != LoadingKind::stretch &&
                            stage.kind != LoadingKind::penetrate && stage.kind != LoadingKind::hold;
  if (stage.stress > 0 && !takes_stress)
    throw InputError(path + "/stress", kind + " takes no stress");
}

/// The stages must fit to each other: a stage can only undo the load of an earlier one.
void check_stages(const std::vector<LoadingStage>& stages, const Settings& settings) {
  constexpr double most_shortening = 0.95;  // or nothing is left between the plates
  double shortening = 0;
  bool loaded = false, open = false;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const LoadingStage& stage = stages[i];
    const std::string path = "/loading/" + std::to_string(i);
    const bool compresses =
        stage.kind == LoadingKind::compress || stage.kind == LoadingKind::isotropic;
    if (compresses) shortening += stage.strain;
    if (shortening > most_shortening)
      throw InputError(path + "/strain",
                       "the sample would be compressed by " + show_rounded(shortening) +
                           " of its height in all; allowed: up to " + show(most_shortening));
    if (stage.kind == LoadingKind::unload && !loaded)
      throw InputError(path + "/kind", "there is nothing to unload; compress the sample before");
    if (open && stage.kind != LoadingKind::penetrate && stage.kind != LoadingKind::hold)
      throw InputError(path + "/kind",
                       "the top plate is away since the stage \"penetrate\"; allowed: penetrate, "
                       "hold");
    check_stage(stage, path, settings);
    loaded = loaded || compresses;
    open = open || stage.kind == LoadingKind::penetrate;
  }
}

class Descriptor final : public DescriptorOf<Descriptor, Settings> {
 public:
  const MethodFacts& facts() const override {
    static const MethodFacts facts{
        "grains",
        "Discrete elements of snow: rigid clumps of spheres with bonds that break",
        {Part::sample},
        "cells",
        names_of(named_energies(Energy{})),
        {{"angular_velocity", "rad/s", "Angular velocity", 3},
         {"equivalent_radius", "m", "Radius of the sphere with a grain's volume"},
         {"coordination", "1", "Number of grains that a grain touches", 1, 1.0}}};
    return facts;
  }

  std::string step_setting() const override { return "courant_factor"; }

  void validate(const SceneView& scene) const override {
    if (!scene.sample) throw InputError("/", "grains need a /sample");
    if (scene.loading.empty())
      throw InputError("/loading",
                       "a sample is loaded in at least one stage, such as {\"kind\": "
                       "\"compress\"}");
    if (scene.dimension != 3) throw InputError("/dimension", "grains move in space; allowed: 3");
    if (scene.events.count != 1)
      throw InputError("/events/count", show(scene.events.count) + " events; a loading is 1");
    check_stages(scene.loading, settings_);
    const auto pushed_in = [](const LoadingStage& s) { return s.kind == LoadingKind::penetrate; };
    if (scene.cone && std::none_of(scene.loading.begin(), scene.loading.end(), pushed_in))
      throw InputError("/cone", "no stage pushes it in; give one of the kind \"penetrate\"");
  }
  std::shared_ptr<const MethodInput> read(const SceneView& scene,
                                          const std::filesystem::path& base_dir) const override {
    return std::make_shared<const Input>(*scene.sample, base_dir);
  }
  std::unique_ptr<Method> build(const SceneView& scene,
                                const Surroundings& surroundings) const override {
    return filled_later(scene, surroundings);
  }

  CostEstimate cost(const CostRequest& request) const override {
    const Sample& sample = sample_of(*request.surroundings);
    check_loading_time(request.scene, sample.box.z());
    const auto grains = filled_later(request.scene, *request.surroundings);
    try {
      grains->add(grains->seed());            // the first step is not known before
    } catch (const SimulationError& error) {  // it is too short
      throw InputError("/numerics/courant_factor", error.what());
    }
    return estimate_cost(request.scene, sample, *grains);
  }
  std::vector<Feature> features(const SceneView& scene, const SceneOutline&) const override {
    return features_of(settings_, scene);
  }

 private:
  static const Sample& sample_of(const Surroundings& surroundings) {
    return dynamic_cast<const Input&>(*surroundings.input).sample();
  }
  std::unique_ptr<Solver> filled_later(const SceneView& scene,
                                       const Surroundings& surroundings) const {
    return make_solver({settings_, scene.gravity, sample_of(surroundings), scene.loading,
                        scene.cone.value_or(Cone{}), scene.output.energy});
  }
};

}  // namespace

const MethodDescriptor& descriptor() {
  static const Descriptor own;
  return own;
}

}  // namespace snowshed::grains
