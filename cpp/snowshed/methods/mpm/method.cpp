// The material point method, as the rest of the program knows it.
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/mpm/boundary.hpp"
#include "snowshed/methods/mpm/cost.hpp"
#include "snowshed/methods/mpm/describe.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed {
namespace mpm {
namespace {

class Descriptor final : public DescriptorOf<Descriptor, MpmSettings> {
 public:
  const MethodFacts& facts() const override {
    static const MethodFacts facts{
        "mpm",
        "The material point method",
        {Part::panel, Part::slab, Part::ground, Part::obstacles, Part::bodies, Part::domain,
         Part::snow, Part::seeding},
        "cells",
        names_of(named_energies(EnergyBalance{})),
        {{"volume_ratio", "1", "Current over initial volume"},
         // Without a step: a film does not keep them, which would be larger by half.
         {"deviatoric_stress", "Pa", "Deviatoric stress, von Mises equivalent of Kirchhoff's"},
         {"preconsolidation_pressure", "Pa",
          "Preconsolidation pressure, hardened or softened; 0: none, or elastic snow"},
         {"volumetric_plastic_strain", "1",
          "Volumetric plastic strain, logarithmic, negative in compaction", 1, 0.01},
         {"be_minus_identity", "1", "Elastic left Cauchy-Green tensor less the identity"},
         {"affine", "1/s", "Affine velocity matrix C of APIC, by rows", 9}}};
    return facts;
  }

  void coarsen(double factor) override { settings_.dx *= factor; }
  std::string step_setting() const override { return "courant_factor"; }
  const char* scalar() const override { return name_of(settings_.precision); }
  std::optional<double> damping_rate(std::int64_t steps, double time) const override {
    return settings_.mean_damping_rate(steps, time);
  }

  void validate(const SceneView&) const override {
    if (settings_.damping_rate && settings_.transfer != Transfer::flip)
      throw InputError("/numerics/damping_rate", "the transfer \"" +
                                                     std::string(name_of(settings_.transfer)) +
                                                     "\" has no PIC that damps; leave it out");
  }
  ThickSolid as_seen(const Shape& shape, int dimension) const override {
    return as_grid_sees(shape, settings_.dx, dimension);
  }
  std::unique_ptr<Method> build(const SceneView& scene,
                                const Surroundings& surroundings) const override {
    MpmOptions o;
    o.dimension = scene.dimension;
    o.gravity = scene.gravity;
    o.snows = surroundings.snows;
    o.settings = settings_;
    o.obstacles = surroundings.resolved;
    o.energy = scene.output.energy;
    return make_mpm(std::move(o));
  }

  CostEstimate cost(const CostRequest& request) const override {
    return estimate_cost(settings_, request);
  }
  std::vector<Feature> features(const SceneView& scene,
                                const SceneOutline& outline) const override {
    return features_of(settings_, scene, outline);
  }
};

}  // namespace

const MethodDescriptor& descriptor() {
  static const Descriptor own;
  return own;
}

}  // namespace mpm
}  // namespace snowshed
