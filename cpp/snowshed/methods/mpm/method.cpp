// The descriptor of the material point method.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/mpm/boundary.hpp"
#include "snowshed/methods/mpm/cost.hpp"
#include "snowshed/methods/mpm/describe.hpp"
#include "snowshed/methods/mpm/device_choice.hpp"
#include "snowshed/methods/mpm/gpu_solver.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {
namespace {

void check_damping(const Settings& n) {
  const std::string transfer = "the transfer \"" + std::string(name_of(n.transfer)) + "\"";
  if (n.damping_rate && n.transfer == Transfer::apic)
    throw InputError("/numerics/damping_rate",
                     transfer + " has no PIC damping; leave damping_rate out");
  if (!n.damps_over_length()) return;
  if (n.transfer != Transfer::affine_flip)
    throw InputError("/numerics/damping_length", "needs the transfer \"affine_flip\", not \"" +
                                                     std::string(name_of(n.transfer)) + "\"");
  if (!n.damping_rate) throw InputError("/numerics/damping_length", "needs a damping_rate, too");
}

/// Lengths and rates may differ from those of the scheme, but each of its mechanisms must act.
void check_scheme(const Settings& n) {
  if (n.scheme != Scheme::objective) return;
  const auto require = [](bool acts, const char* key, const std::string& is, const char* must) {
    if (!acts)
      throw InputError(std::string("/numerics/") + key,
                       "is " + is + ", but the scheme \"objective\" requires " + must +
                           "; remove this setting or the scheme");
  };
  require(n.transfer == Transfer::affine_flip, "transfer",
          "\"" + std::string(name_of(n.transfer)) + "\"", "\"affine_flip\"");
  require(n.contact == ContactRule::touch, "contact", "\"" + std::string(name_of(n.contact)) + "\"",
          "\"touch\"");
  require(n.fields == Fields::events, "fields", "\"one\"", "\"events\"");
  require(n.damps_over_length(), "damping_length", "0", "a length");
  require(n.crack_band_length > 0, "crack_band_length", "0", "a length");
}

/// Softening is faster by dx / crack_band_length. On much finer grids snow would keep its strength
/// up to strains that a particle cannot follow. On much coarser grids it would lose its strength at
/// once.
void check_crack_band(const Settings& n) {
  constexpr double min_softening = 0.1, max_softening = 100;
  if (n.softening() >= min_softening * (1 - 1e-9) && n.softening() <= max_softening) return;
  throw InputError("/numerics/crack_band_length", "is " + show_rounded(1 / n.softening()) +
                                                      " times dx; it must be " +
                                                      show_rounded(1 / max_softening) + " to " +
                                                      show_rounded(1 / min_softening) + " times");
}

class Descriptor final : public DescriptorBase<Descriptor, Settings> {
 public:
  const MethodInfo& info() const override {
    static const MethodInfo info{
        "mpm",
        "The material point method",
        {Part::panel, Part::slab, Part::ground, Part::obstacles, Part::bodies, Part::domain,
         Part::snow, Part::seeding},
        "cells",
        names_of(named_energies(EnergyBalance{})),
        {{"volume_ratio", "1", "Current over initial volume"},
         // The next two have no film_step: films with them would be half as large again.
         {"deviatoric_stress", "Pa", "Deviatoric stress, von Mises equivalent of Kirchhoff's"},
         {"preconsolidation_pressure", "Pa",
          "Preconsolidation pressure, hardened or softened; 0: none, or elastic snow"},
         {"volumetric_plastic_strain", "1",
          "Volumetric plastic strain, logarithmic, negative in compaction", 1, 0.01},
         {"be_minus_identity", "1", "Elastic left Cauchy-Green tensor less the identity"},
         {"affine", "1/s", "Affine velocity matrix C of APIC, by rows", 9}},
        true,
        true,
        true};
    return info;
  }

  void adopt_machine(const MethodDescriptor& other) override {
    DescriptorBase::adopt_machine(other);
    if (const auto* same = dynamic_cast<const Descriptor*>(&other))
      settings_.device = same->settings_.device;
  }
  void coarsen(double factor) override { settings_.dx *= factor; }
  std::string step_setting() const override { return "courant_factor"; }
  const char* scalar() const override { return name_of(settings_.precision); }
  std::optional<double> damping_rate(std::int64_t steps, double time) const override {
    return settings_.mean_damping_rate(steps, time);
  }

  void validate(const SceneView&) const override {
    check_scheme(settings_);
    check_damping(settings_);
    check_crack_band(settings_);
  }
  std::vector<UnusedSettings> unused_settings(const SceneView&) const override {
    return mpm::unused_settings(settings_);
  }
  geometry::ThickSolid thickened(const geometry::Shape& shape, int dimension) const override {
    return thickened_for_grid(shape, settings_.dx, dimension);
  }
  DeviceChoice choose_device(const SceneView& scene, const Surroundings& surroundings,
                             const CostEstimate& cost) const override {
    if (settings_.device == DeviceSetting::cpu) return {};
    return mpm::choose_device(options_of(scene, surroundings), cost.total_particles);
  }
  std::unique_ptr<Method> build(const SceneView& scene,
                                const Surroundings& surroundings) const override {
    const std::shared_ptr<snowshed::gpu::Device>& card = surroundings.device.card;
    if (card) return make_gpu_solver(options_of(scene, surroundings), card);
    return make_solver(options_of(scene, surroundings));
  }

  CostEstimate cost_of_bodies(const SceneView& scene, const SceneOutline& outline,
                              std::vector<double> particles) const override {
    return estimate_cost(settings_, scene, outline, std::move(particles));
  }
  std::vector<Feature> features(const SceneView& scene,
                                const SceneOutline& outline) const override {
    return features_of(settings_, scene, outline);
  }

 private:
  Options options_of(const SceneView& scene, const Surroundings& surroundings) const {
    Options o;
    o.dimension = scene.dimension;
    o.gravity = scene.gravity;
    o.snows = surroundings.snows;
    o.settings = settings_;
    o.obstacles = surroundings.resolved;
    for (const Obstacle& obstacle : surroundings.obstacles) o.surfaces.push_back(obstacle.shape);
    o.energy = scene.output.energy;
    o.forces = scene.output.forces;
    o.laws = surroundings.laws;
    return o;
  }
};

}  // namespace

const MethodDescriptor& descriptor() {
  static const Descriptor own;
  return own;
}

}  // namespace snowshed::methods::mpm
