// Cost of a run of the material point method, and the features that a scene uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/mpm/settings.hpp"

namespace snowshed::methods::mpm {

/// Returns the first time step (s) of snow at rest. The stiffest snow limits it.
double stable_time_step(const Settings&, const std::vector<material::Snow>&, int dimension);

CostEstimate estimate_cost(const Settings&, const SceneView&, const SceneOutline&,
                           std::vector<double> particles);

std::vector<Feature> features_of(const Settings&, const SceneView&, const SceneOutline&);

}  // namespace snowshed::methods::mpm
