// What a snow slide will cost, by the way of a single block down the fall line.
#pragma once

#include "snowshed/methods/slide/solver.hpp"
#include "snowshed/run/cost_estimate.hpp"

namespace snowshed {

/// The time until a block of the release's thickness, starting at the middle of the first release
/// area, has stopped or left the terrain, at most `max_time` (s).
double block_travel_time(const Terrain& terrain, const SlideSettings& settings,
                         const SlideArea& release, double gravity, double max_time);

/// `particles` are those of the release.
CostEstimate estimate_slide_cost(const Scene& scene, const Terrain& terrain,
                                 const SlideArea& release, std::size_t particles);

}  // namespace snowshed
