// Cost of a loading test of grains, from its time and its spheres, and the features that it uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::methods::grains {

/// The time (s) of the stages on a sample of this height (m) if none ends before its strain. The
/// time of `hold` counts as zero.
double loading_time(const std::vector<LoadingStage>&, double height);

/// Throws InputError if the stages take longer than an event of the scene may last.
void check_loading_time(const SceneView&, double height);

/// The finished part of the loading, 0 to 1. `strain` is that of the present stage; stages are
/// weighted with their times.
double loading_progress(const std::vector<LoadingStage>&, int stage, double strain);

/// The cost of the test. `grains` holds the sample; its first time step and its memory are used.
CostEstimate estimate_cost(const SceneView&, const Sample&, const Method& grains);

std::vector<Feature> features_of(const Settings&, const SceneView&);

}  // namespace snowshed::methods::grains
