// Cost of a scene by arithmetic alone: nothing is seeded or simulated.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// Totals of the solids and the snow of a resolved scene.
methods::SceneOutline outline_of(const scene::Scene& scene);

/// The cost of a scene whose method takes bodies. `particles`, the number of new particles in each
/// event, replaces the estimate from the volumes, which leaves out snow whose volume the scene does
/// not give (meshes and grids).
methods::CostEstimate estimate_cost(const scene::Scene& scene);
methods::CostEstimate estimate_cost(const scene::Scene& scene, std::vector<double> particles);

/// Throws InputError, which names the setting, if an event would take more than 10^12 steps or be
/// recorded more than a million times.
void check_duration(const scene::Scene&, const methods::CostEstimate&);

/// Throws InputError naming both numbers when `bytes` exceeds `available`; by default this is the
/// memory of the machine, or of the container if it has less.
void check_memory(double bytes);
void check_memory(double bytes, double available);

}  // namespace snowshed::run
