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

namespace snowshed {

/// A layer of the slab or a body that was filled with particles.
struct SeededBody {
  std::string path;  // in the scene
  Shape shape;
  bool is_of_slab = false;
};

/// The slab and the bodies of one event, as particles.
struct SeededSnow {
  std::vector<ParticleBatch> batches;  // one for each layer of the slab, then for each body
  std::vector<SeededBody> bodies;      // bodies of the batches; none if the method seeds its own
  std::vector<std::string> notes;      // notes on bodies that particles do not resolve
  double mass = 0;                     // kg
  double height_on_panel = 0;          // m along its normal: the slab, and bodies over the panel
};

/// Seeds the snow of `event` (1 is the first), its slab `lift` metres above the panel. Throws
/// InputError naming the layer or body that cannot be seeded, and Stopped on request.
SeededSnow seed_event(const Scene& scene, const std::filesystem::path& base_dir,
                      const PanelRegion& panel, int event, double lift,
                      const StopRequest& stop = {});

/// The snow of a method that seeds its own.
SeededSnow seeded(std::vector<ParticleBatch>);

/// Returns the mass of the slab laid at the start of an event, kg.
double slab_mass(const Scene& scene, int event);

/// Returns how many particles each event will bring, by the volumes of its snow, or exactly where
/// the method fills bodies itself; reads the files of bodies. Throws InputError if a body cannot
/// be built or is too small for a particle.
std::vector<double> count_particles(const Scene& scene, const std::filesystem::path& base_dir);

}  // namespace snowshed
