// Cost of a run of the moving particle semi-implicit method, and the features that a scene uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/mps/settings.hpp"

namespace snowshed::methods::mps {

CostEstimate estimate_cost(const Settings&, const SceneView&, const SceneOutline&,
                           std::vector<double> particles);

std::vector<Feature> features_of(const Settings&, const SceneView&);

}  // namespace snowshed::methods::mps
