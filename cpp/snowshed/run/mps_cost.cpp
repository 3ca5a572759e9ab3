#include "snowshed/run/mps_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed {
namespace {

/// Of a particle with its neighbours, measured in 2D and 3D.
constexpr double bytes_per_particle[] = {1200, 3000};

/// The height of all snow and obstacles in which it may fall, m.
double height_of(const Scene& scene) {
  double low = 0, high = 0;
  for (const BodySpec& body : assemble_bodies(scene, 1))
    if (const auto bounds = shape_bounds(body.shape)) {
      low = std::min(low, bounds->min().z());
      high = std::max(high, bounds->max().z());
    }
  return high - low;
}

}  // namespace

CostEstimate estimate_mps_cost(const Scene& scene, std::vector<double> particles) {
  const MpsSettings& s = std::get<MpsSettings>(scene.numerics);
  CostEstimate cost;
  cost.total_particles = std::accumulate(particles.begin(), particles.end(), 0.0);
  cost.particles = std::move(particles);
  const double speed = std::sqrt(2 * scene.gravity * std::max(height_of(scene), s.spacing));
  cost.time_step = std::min(s.max_time_step, s.courant_factor * s.spacing / std::max(speed, 1e-9));
  cost.slides = true;
  cost.event_time = scene.events.max_time;
  cost.steps = scene.events.count * std::ceil(cost.event_time / cost.time_step);
  double held = 0;
  for (const double fresh : cost.particles) {
    held += fresh;
    cost.updates += held * std::ceil(cost.event_time / cost.time_step);
  }
  cost.bytes = bytes_per_particle[scene.dimension - 2] * cost.total_particles;
  return cost;
}

}  // namespace snowshed
