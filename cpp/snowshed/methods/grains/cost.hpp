// Cost of a loading test of grains, by its time and its spheres, and the features that it uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::grains {

/// The time (s) that the stages take on a sample of this height (m) if none ends before its strain;
/// `hold` counts as zero.
double loading_time(const std::vector<LoadingStage>&, double height);

/// Throws InputError if that is longer than an event of the scene may last.
void check_loading_time(const SceneView&, double height);

/// The finished part of the loading, by strain; stages are weighted with their times.
double loading_progress(const std::vector<LoadingStage>&, int stage, double strain);

/// The first time step and the memory are those of `grains`, which hold the sample.
CostEstimate estimate_cost(const SceneView&, const Sample&, const Method& grains);

std::vector<Feature> features_of(const Settings&, const SceneView&);

}  // namespace snowshed::grains
