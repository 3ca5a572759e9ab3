// The descriptor of the grains.
#include <algorithm>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/grains/check_options.hpp"
#include "snowshed/methods/grains/cost.hpp"
#include "snowshed/methods/grains/describe.hpp"
#include "snowshed/methods/grains/energy.hpp"
#include "snowshed/methods/grains/input.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::methods::grains {
namespace {

class Descriptor final : public DescriptorBase<Descriptor, Settings> {
 public:
  const MethodInfo& info() const override {
    static const MethodInfo info{
        "grains",
        "Discrete elements of snow: rigid clumps of spheres with bonds that break",
        {Part::sample},
        "cells",
        names_of(named_energies(EnergyBalance{})),
        {{"angular_velocity", "rad/s", "Angular velocity", 3},
         {"equivalent_radius", "m", "Radius of the sphere with a grain's volume"},
         {"coordination", "1", "Number of grains that a grain touches", 1, 1.0}}};
    return info;
  }

  std::string step_setting() const override { return "courant_factor"; }

  void validate(const SceneView& scene) const override {
    if (!scene.sample) throw InputError("/", "grains need a /sample");
    if (scene.loading.empty())
      throw InputError("/loading",
                       "a sample is loaded in at least one stage, such as {\"kind\": "
                       "\"compress\"}");
    if (scene.dimension != 3)
      throw InputError("/dimension", "grains need three dimensions; allowed: 3");
    if (scene.events.count != 1)
      throw InputError("/events/count",
                       show(scene.events.count) + " events; a loading test is one event");
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
    return empty_solver(scene, surroundings);
  }

  CostEstimate cost_of_method(const SceneView& scene, const Surroundings& surroundings,
                              const Method&) const override {
    const Sample& sample = sample_of(surroundings);
    check_loading_time(scene, sample.box.z());
    const auto grains = empty_solver(scene, surroundings);
    try {
      grains->add(grains->seed());            // only then the first step is known
    } catch (const SimulationError& error) {  // the step is too short
      throw InputError("/numerics/courant_factor", error.what());
    }
    return estimate_cost(scene, sample, *grains);
  }
  std::vector<Feature> features(const SceneView& scene, const SceneOutline&) const override {
    return features_of(settings_, scene);
  }

 private:
  static const Sample& sample_of(const Surroundings& surroundings) {
    return dynamic_cast<const Input&>(*surroundings.input).sample();
  }
  std::unique_ptr<Solver> empty_solver(const SceneView& scene,
                                       const Surroundings& surroundings) const {
    Options o;
    o.settings = settings_;
    o.gravity = scene.gravity;
    o.sample = sample_of(surroundings);
    o.loading = scene.loading;
    o.cone = scene.cone.value_or(Cone{});
    o.energy = scene.output.energy;
    return make_solver(std::move(o));
  }
};

}  // namespace

const MethodDescriptor& descriptor() {
  static const Descriptor instance;
  return instance;
}

}  // namespace snowshed::methods::grains
