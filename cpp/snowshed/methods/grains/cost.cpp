#include "snowshed/methods/grains/cost.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/enum_names.hpp"

namespace snowshed::methods::grains {
namespace {

/// The time of a stage per height of the sample, s/m.
double slowness(const LoadingStage& stage) {
  return stage.kind == LoadingKind::hold ? 0.0 : stage.strain / stage.speed;
}

}  // namespace

double loading_time(const std::vector<LoadingStage>& stages, double height) {
  double time = 0;
  for (const LoadingStage& stage : stages) time += height * slowness(stage);
  return time;
}

double loading_progress(const std::vector<LoadingStage>& stages, int stage, double strain) {
  const auto finished_stages = std::min(std::size_t(stage), stages.size());
  const double all = loading_time(stages, 1.0);
  if (finished_stages == stages.size()) return 1.0;
  if (all <= 0) return 0.0;
  double passed = 0;
  for (std::size_t i = 0; i < finished_stages; ++i) passed += slowness(stages[i]);
  passed += slowness(stages[finished_stages]) *
            std::clamp(strain / stages[finished_stages].strain, 0.0, 1.0);
  return passed / all;
}

void check_loading_time(const SceneView& scene, double height) {
  const double needed = loading_time(scene.loading, height), allowed = scene.events.max_time;
  if (needed > allowed)
    throw InputError("/events/max_time", "the stages take " + show_rounded(needed) +
                                             " s on a sample of " + show_rounded(height) +
                                             " m, longer than " + show(allowed) + " s");
}

CostEstimate estimate_cost(const SceneView& scene, const Sample& sample, const Method& grains) {
  CostEstimate cost;
  cost.particles = {double(sample.clumps.size())};
  cost.total_particles = cost.particles.front();
  cost.parts = {{"spheres", double(sample.spheres.size())}, {"bonds", double(sample.bonds.size())}};
  cost.time_step = grains.time_step();
  cost.event_time = std::min(loading_time(scene.loading, sample.box.z()), scene.events.max_time);
  cost.steps = std::ceil(cost.event_time / cost.time_step);
  cost.updates = cost.steps * cost.total_particles;
  cost.bytes = double(grains.bytes());
  return cost;
}

std::vector<Feature> features_of(const Settings& s, const SceneView& scene) {
  std::vector<Feature> features;
  for (const auto& [kind, name] : EnumNames<LoadingKind>::list)
    features.push_back({name, std::any_of(scene.loading.begin(), scene.loading.end(),
                                          [kind = kind](const LoadingStage& stage) {
                                            return stage.kind == kind;
                                          })});
  features.insert(features.end(),
                  {{"periodic sides", s.sides == Sides::periodic},
                   {"bonded plates", s.bonded_plates},
                   {"density scaling", s.density_scaling > 1},
                   {"gravity", scene.gravity > 0},
                   {"energy balance", scene.output.energy},
                   {"snapshots during the loading", scene.output.snapshot_interval > 0}});
  return features;
}

}  // namespace snowshed::methods::grains
