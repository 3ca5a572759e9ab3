#include "snowshed/run/slide_cost.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/slide/friction.hpp"

namespace snowshed {
namespace {

/// Memory of a particle with three bonds, and of a node of the terrain.
constexpr double bytes_per_particle = 620, bytes_per_node = 100;

MapPoint middle(const Ring& ring) {
  MapPoint sum{0, 0};
  for (const MapPoint& p : ring) sum = {sum[0] + p[0], sum[1] + p[1]};
  return {sum[0] / double(ring.size()), sum[1] / double(ring.size())};
}

}  // namespace

double block_travel_time(const Terrain& terrain, const SlideSettings& s, const SlideArea& release,
                         double gravity, double max_time) {
  const BasalFriction law = BasalFriction::from(s, gravity);
  const double dt = 0.05, drag = law.drag / (s.density * release.thickness);
  const MapPoint start = middle(release.polygon.outline);
  Vec3 x(start[0], start[1], 0), u = Vec3::Zero();
  double time = 0;
  for (; time < max_time; time += dt) {
    const GridPlace place = terrain.place(x.x(), x.y());
    if (!place.inside() || !terrain.known(place)) break;
    const Vec3 n = terrain.normal(place);
    u -= u.dot(n) * n;
    u += dt * gravity * (n.z() * n - Vec3::UnitZ());
    const double speed = u.norm();
    const double slowed = speed - dt * (law.friction * gravity * n.z() + drag * speed * speed);
    if (slowed <= 0) break;
    u *= slowed / speed;
    x += dt * u;
  }
  return std::max(time, dt);
}

CostEstimate estimate_slide_cost(const Scene& scene, const Terrain& terrain,
                                 const SlideArea& release, std::size_t particles) {
  const SlideSettings& s = std::get<SlideSettings>(scene.numerics);
  CostEstimate cost;
  cost.particles = {double(particles)};
  cost.total_particles = double(particles);
  cost.time_step = s.time_step;
  cost.slides = true;
  // The snow spreads meanwhile, and its last parts creep.
  constexpr double longer_than_block = 1.5;
  cost.slide_time = block_travel_time(terrain, s, release, scene.gravity, scene.events.max_time);
  cost.event_time = std::min(longer_than_block * cost.slide_time, scene.events.max_time);
  cost.steps = std::ceil(cost.event_time / cost.time_step);
  cost.updates = cost.steps * double(particles);
  cost.bytes = bytes_per_particle * double(particles) +
               bytes_per_node * double(terrain.columns()) * double(terrain.rows());
  return cost;
}

}  // namespace snowshed
