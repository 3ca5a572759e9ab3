// What a run of the moving particle semi-implicit method will cost.
#pragma once

#include "snowshed/run/cost_estimate.hpp"

namespace snowshed {

/// `particles` are those that are new in each event.
CostEstimate estimate_mps_cost(const Scene& scene, std::vector<double> particles);

}  // namespace snowshed
