// The descriptor of the block.
#pragma once

#include <cmath>

#include "methods/block/solver.hpp"
#include "snowshed/methods/descriptor.hpp"

namespace snowshed::methods::block {

class Descriptor final : public DescriptorBase<Descriptor, Settings> {
 public:
  const MethodInfo& info() const override {
    static const MethodInfo info{"block",  "A rigid block on a plane",      {},
                                 "blocks", names_of(Solver({}).energies()), {}};
    return info;
  }
  std::string step_setting() const override { return "time_step"; }
  void validate(const SceneView& scene) const override {
    if (scene.dimension != 3)
      throw InputError("/dimension", "a block needs three dimensions; allowed: 3");
  }
  std::unique_ptr<Method> build(const SceneView& scene, const Surroundings&) const override {
    return std::make_unique<Solver>(Model{settings_, scene.gravity});
  }
  CostEstimate cost_of_method(const SceneView& scene, const Surroundings&,
                              const Method&) const override {
    CostEstimate cost;
    cost.particles = {1};
    cost.total_particles = 1;
    cost.time_step = settings_.time_step;
    cost.event_time = scene.events.max_time;
    cost.steps = cost.updates = std::ceil(cost.event_time / cost.time_step);
    return cost;
  }
  std::vector<Feature> features(const SceneView&, const SceneOutline&) const override {
    return {{"friction", settings_.friction > 0}};
  }
};

}  // namespace snowshed::methods::block
