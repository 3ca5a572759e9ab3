// Cost of a snow slide, and the features that a scene uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed::methods::slide {

/// The time until a block of the release's thickness, starting at the middle of the first release
/// area, has stopped or left the terrain, at most `max_time` (s).
double block_travel_time(const Terrain& terrain, const Settings& settings, const Area& release,
                         double gravity, double max_time);

CostEstimate estimate_cost(const Settings&, const SceneView&, const Area& release, const Solver&);

std::vector<Feature> features_of(const Settings&, const SceneView&);

}  // namespace snowshed::methods::slide
