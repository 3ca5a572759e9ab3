// Cost of a loading test of grains, by its time and its spheres, and the features that it uses.
#pragma once

#include <vector>

#include "snowshed/methods/cost.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::grains {

/// The time that the stages take on a sample of that height (m), if none ends before its strain, s;
/// to hold takes none.
double loading_time(const std::vector<LoadingStage>&, double height);

/// Throws InputError where that is longer than the scene's events may be.
void check_loading_time(const SceneView&, double height);

/// The part of the loading that is done: strain by strain, each weighted with the time it takes.
double loading_progress(const std::vector<LoadingStage>&, int stage, double strain);

/// The first time step and the memory are those of `grains`, which hold the sample.
CostEstimate estimate_cost(const SceneView&, const Sample&, const Method& grains);

std::vector<Feature> features_of(const Settings&, const SceneView&);

}  // namespace snowshed::grains
