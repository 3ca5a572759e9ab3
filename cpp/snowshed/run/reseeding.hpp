// Reseeding between events (thesis A.3.5): the stack is converted to a solid, which is filled with
// new particles.
#pragma once

#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/panel_region.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// The stack before and after reseeding.
struct Reseeding {
  struct Cloud {
    std::vector<Vec3> positions;    // m
    std::vector<double> masses;     // kg
    std::vector<double> densities;  // kg/m3, initial
    std::vector<bool> on_panel;
  };
  Cloud before, after;
  std::vector<methods::ParticleBatch> batches;  // the particles after, by event and snow
};

/// Reseeds the stack `old` before the event that follows `event`: at rest, in its initial
/// state, with its mass. Event and snow of a new particle are those of the old one nearest to it,
/// and each snow keeps its mass. The snow that stayed on the panel is converted along with it, so
/// nothing is lost. Throws SimulationError if the stack cannot be converted, and Stopped on
/// request.
Reseeding reseed_stack(const scene::Scene& scene, const PanelRegion& panel,
                       methods::ParticleState old, int event, double laid_height,
                       const StopRequest& stop = {});

}  // namespace snowshed::run
