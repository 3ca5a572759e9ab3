#include "snowshed/methods/slide/cost.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/slide/friction.hpp"

namespace snowshed::methods::slide {
namespace {

/// Bytes of a particle with three bonds, and of a node of the terrain.
constexpr double bytes_per_particle = 620, bytes_per_node = 100;

geometry::Point2 middle(const geometry::Ring& ring) {
  geometry::Point2 sum{0, 0};
  for (const geometry::Point2& p : ring) sum = {sum[0] + p[0], sum[1] + p[1]};
  return {sum[0] / double(ring.size()), sum[1] / double(ring.size())};
}

}  // namespace

double block_travel_time(const Terrain& terrain, const Settings& s, const Area& release,
                         double gravity, double max_time) {
  const BasalFriction law = BasalFriction::from(s, gravity);
  const double dt = 0.05, drag = law.drag / (s.density * release.thickness);
  const geometry::Point2 start = middle(release.polygon.outline);
  Vec3 x(start[0], start[1], 0), u = Vec3::Zero();
  double time = 0;
  for (; time < max_time; time += dt) {
    const geometry::CellPosition position = terrain.cell_position(x.x(), x.y());
    if (!position.inside() || !terrain.known(position)) break;
    const Vec3 n = terrain.normal(position);
    u -= u.dot(n) * n;
    u += dt * gravity * (n.z() * n - Vec3::UnitZ());
    const double speed = u.norm();
    const double after_friction =
        speed - dt * (law.friction * gravity * n.z() + drag * speed * speed);
    if (after_friction <= 0) break;
    u *= after_friction / speed;
    x += dt * u;
  }
  return std::max(time, dt);
}

CostEstimate estimate_cost(const Settings& s, const SceneView& scene, const Area& release,
                           const Solver& slide) {
  const Terrain& terrain = slide.terrain();
  const auto particles = double(slide.count_seeds());
  const double max_time = scene.events.max_time;
  CostEstimate cost;
  cost.particles = {particles};
  cost.total_particles = particles;
  cost.time_step = longest_step(s);
  // The slide takes longer than a block, because the snow spreads and its last parts creep.
  constexpr double longer_than_block = 1.5;
  const double block = block_travel_time(terrain, s, release, scene.gravity, max_time);
  cost.event_time = std::min(longer_than_block * block, max_time);
  cost.steps = std::ceil(cost.event_time / cost.time_step);
  cost.updates = cost.steps * particles;
  cost.bytes = bytes_per_particle * particles +
               bytes_per_node * double(terrain.columns()) * double(terrain.rows());
  return cost;
}

std::vector<Feature> features_of(const Settings& s, const SceneView& scene) {
  return {{"cohesive bonds", s.bonds},
          {"turbulent friction (Voellmy)", s.friction_law == FrictionLaw::voellmy},
          {"artificial viscosity",
           (s.mode == Mode::compatible ? s.artificial_viscosity : s.mixing_rate) > 0},
          {"entrainment and splitting", !scene.terrain->entrainment.empty()},
          {"resistance areas", !scene.terrain->resistance.empty()},
          {"detrainment", s.detrainment > 0 && !scene.terrain->resistance.empty()},
          {"secondary releases", !scene.terrain->secondary_release.empty()},
          {"inflows", !scene.terrain->inflows.empty()},
          {"dams", !scene.terrain->dams.empty()},
          {"ground that adapts to the snow", s.changes_ground()},
          {"resampled terrain", s.cell > 0},
          {"snapshots during the slide", scene.output.snapshot_interval > 0}};
}

}  // namespace snowshed::methods::slide
