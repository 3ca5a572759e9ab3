// The descriptor of the moving particle semi-implicit method.
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/mps/boundary.hpp"
#include "snowshed/methods/mps/cost.hpp"
#include "snowshed/methods/mps/describe.hpp"
#include "snowshed/methods/mps/seeding.hpp"
#include "snowshed/methods/mps/solver.hpp"
#include "snowshed/sampling/lattice.hpp"

namespace snowshed::methods::mps {
namespace {

class Descriptor final : public DescriptorBase<Descriptor, Settings> {
 public:
  const MethodInfo& info() const override {
    static const MethodInfo info{
        "mps",
        "The moving particle semi-implicit method: snow as a Bingham and dilatant fluid",
        {Part::panel, Part::slab, Part::ground, Part::obstacles, Part::bodies, Part::domain},
        "spacings",
        names_of(named_energies(EnergyBalance{})),
        {{"number_density", "1", "Number density of particles over that of a lattice", 1, 0.01},
         {"shear_rate", "1/s", "Shear rate, the root of 2 D:D"},
         {"apparent_viscosity", "Pa s", "Shear stress over shear rate"},
         {"particle_kind", "1", "0: moving, 1: erodible, 2: inner wall, 3: dummy wall", 1, 1.0}},
        true};
    return info;
  }

  std::string step_setting() const override {
    // The Courant factor shortens the steps that max_time_step allows.
    return settings_.max_time_step < settings_.courant_factor * settings_.spacing
               ? "max_time_step"
               : "courant_factor";
  }

  void validate(const SceneView& scene) const override {
    const Settings& s = settings_;
    if (s.erosion && s.deposition_pressure >= s.erosion_pressure)
      throw InputError("/numerics/deposition_pressure",
                       show(s.deposition_pressure) + " Pa must be less than " +
                           "/numerics/erosion_pressure = " + show(s.erosion_pressure));
    if (s.erosion && s.deposition_speed >= s.erosion_speed)
      throw InputError("/numerics/deposition_speed",
                       show(s.deposition_speed) + " m/s must be less than " +
                           "/numerics/erosion_speed = " + show(s.erosion_speed));
    check_order(s);
    if (scene.output.energy && s.order == Order::published)
      throw InputError("/output/energy",
                       "the balance is kept with /numerics/order \"single_move\" only");
    if (scene.output.forces && s.order == Order::published)
      throw InputError("/output/forces",
                       "they are recorded with /numerics/order \"single_move\" only");
  }
  std::vector<UnusedSettings> unused_settings(const SceneView&) const override {
    return mps::unused_settings(settings_);
  }
  geometry::ThickSolid thickened(const geometry::Shape& shape, int dimension) const override {
    return thickened_for_particles(shape, settings_.spacing, dimension);
  }
  std::unique_ptr<Method> build(const SceneView& scene,
                                const Surroundings& surroundings) const override {
    Options o;
    o.dimension = scene.dimension;
    o.gravity = -scene.gravity * Vec3::UnitZ();
    o.settings = settings_;
    o.obstacles = surroundings.resolved;
    o.energy = scene.output.energy;
    o.forces = scene.output.forces;
    return make_solver(std::move(o));
  }

  std::size_t count_particles(const geometry::LevelSet& shape, int dimension) const override {
    return sampling::count_lattice(shape, dimension, settings_.spacing);
  }
  void fill(const geometry::LevelSet& shape, int dimension, const StopRequest& stop,
            ParticleBatch& batch, std::vector<std::string>& notes) const override {
    seed_on_lattice(settings_, shape, dimension, stop, batch, notes);
  }

  CostEstimate cost_of_bodies(const SceneView& scene, const SceneOutline& outline,
                              std::vector<double> particles) const override {
    return estimate_cost(settings_, scene, outline, std::move(particles));
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

}  // namespace snowshed::methods::mps
