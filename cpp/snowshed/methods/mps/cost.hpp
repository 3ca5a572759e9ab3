// What a run of the moving particle semi-implicit method will cost, and which of its features a
// scene uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/mps/settings.hpp"

namespace snowshed {

CostEstimate estimate_cost(const MpsSettings&, const CostRequest&);

std::vector<Feature> features_of(const MpsSettings&, const SceneView&);

}  // namespace snowshed
