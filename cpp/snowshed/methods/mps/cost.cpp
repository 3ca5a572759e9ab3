#include "snowshed/methods/mps/cost.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snowshed::methods::mps {
namespace {

/// Bytes of a particle with its neighbours, measured in 2D and 3D.
constexpr double bytes_per_particle[] = {1200, 3000};

}  // namespace

CostEstimate estimate_cost(const Settings& s, const SceneView& scene, const SceneOutline& outline,
                           std::vector<double> particles) {
  CostEstimate cost;
  cost.particles = std::move(particles);
  cost.total_particles = std::accumulate(cost.particles.begin(), cost.particles.end(), 0.0);
  const double speed = std::sqrt(2 * scene.gravity * std::max(outline.height, s.spacing));
  cost.time_step = std::min(s.max_time_step, s.courant_factor * s.spacing / std::max(speed, 1e-9));
  cost.event_time = scene.events.max_time;
  cost.steps = scene.events.count * std::ceil(cost.event_time / cost.time_step);
  double particles_so_far = 0;
  for (const double added : cost.particles) {
    particles_so_far += added;
    cost.updates += particles_so_far * std::ceil(cost.event_time / cost.time_step);
  }
  cost.bytes = bytes_per_particle[scene.dimension - 2] * cost.total_particles;
  return cost;
}

std::vector<Feature> features_of(const Settings& s, const SceneView& scene) {
  return {{"third dimension", scene.dimension == 3},
          {"yield stress", s.rheology != ShearLaw::newtonian},
          {"dilatant branch", s.rheology == ShearLaw::bingham_dilatant},
          {"erosion and deposition", s.erosion},
          {"wall particles", s.walls == Walls::particles},
          {"collisions", s.spacing_law == SpacingLaw::collision},
          {"particle shifting", s.spacing_law == SpacingLaw::shifting},
          {"multigrid", s.preconditioner == Preconditioner::multigrid},
          {"energy balance", scene.output.energy},
          {"snapshots during events", scene.output.snapshot_interval > 0}};
}

}  // namespace snowshed::methods::mps
