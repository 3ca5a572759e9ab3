// The snow that an event brings: its amount and its particles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/level_set.hpp"
#include "snowshed/methods/particle_batch.hpp"
#include "snowshed/run/panel_region.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// A layer of the slab or a body that was filled with particles.
struct SeededBody {
  std::string path;  // in the scene
  geometry::Shape shape;
  bool is_of_slab = false;
};

/// The slab and the bodies of one event, as particles.
struct SeededSnow {
  std::vector<methods::ParticleBatch>
      batches;                     // one for each layer of the slab, then for each body
  std::vector<SeededBody> bodies;  // bodies of the batches; none if the method seeds its own
  std::vector<std::string> notes;  // notes on bodies that particles do not resolve
  double mass = 0;                 // kg
  double height_on_panel = 0;      // m along its normal: the slab, and bodies over the panel
};

/// Seeds the snow of `event` (1 is the first), its slab `lift` metres above the panel. Throws
/// InputError naming the layer or body that cannot be seeded, and Stopped on request.
SeededSnow seed_event(const scene::Scene& scene, const std::filesystem::path& base_dir,
                      const PanelRegion& panel, int event, double lift,
                      const StopRequest& stop = {});

/// The snow of a method that seeds its own.
SeededSnow seeded(std::vector<methods::ParticleBatch>);

/// Returns the mass of the slab laid at the start of an event, kg.
double slab_mass(const scene::Scene& scene, int event);

/// Returns the number of new particles in each event: exact if the method fills bodies itself,
/// otherwise estimated from their volumes. Reads the files of bodies. Throws InputError if a body
/// cannot be built or is too small for a particle.
std::vector<double> count_particles(const scene::Scene& scene,
                                    const std::filesystem::path& base_dir);

}  // namespace snowshed::run
