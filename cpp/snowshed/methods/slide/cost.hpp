// What a snow slide will cost, and which of its features a scene uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed {

/// The time until a block of the release's thickness, starting at the middle of the first release
/// area, has stopped or left the terrain, at most `max_time` (s).
double block_travel_time(const Terrain& terrain, const SlideSettings& settings,
                         const SlideArea& release, double gravity, double max_time);

CostEstimate estimate_cost(const SlideSettings&, const SceneView&, const SlideArea& release,
                           const SlideMethod&);

std::vector<Feature> features_of(const SlideSettings&, const SceneView&);

}  // namespace snowshed
