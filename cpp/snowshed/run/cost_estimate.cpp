#include "snowshed/run/cost_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/material/elasticity.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/time_step.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/locator.hpp"
#include "snowshed/scene/message_format.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed {
namespace {

/// Memory of the solver. A particle holds position, velocity, deformation gradient, affine
/// matrix, volume, mass, plastic strain and sorting keys; a grid node mass, momentum and force,
/// in blocks that are only partly filled.
struct Storage {
  double bytes_per_particle, bytes_per_voxel;
};

constexpr Storage storage(int dimension, Precision precision) {
  const bool single = precision == Precision::float32;
  if (dimension == 2) return single ? Storage{90.0, 32.0} : Storage{180.0, 64.0};
  return single ? Storage{150.0, 48.0} : Storage{300.0, 96.0};
}

/// Of a contact between a node and an obstacle, which is there twice while blocks are sorted, and
/// of an obstacle with its shape, apart from files.
struct ObstacleStorage {
  double bytes_per_contact, bytes_per_obstacle;
};

constexpr ObstacleStorage obstacle_storage(Precision precision) {
  return precision == Precision::float32 ? ObstacleStorage{100.0, 500.0}
                                         : ObstacleStorage{200.0, 1000.0};
}

/// Grid voxels in use for each voxel of snow: the splines reach beyond it, and it spreads.
constexpr double grid_spread = 4.0;

/// From the last impact to rest, snow loses the speed of its fall at about the acceleration of
/// gravity: 0.2 to 0.35 s in the laboratory scene, 0.5 to 0.7 s where it falls from 2 m. Less than
/// this it never took:
constexpr double least_settling_time = 0.25;  // s

/// Share of the older snow that new snow keeps awake from its first landing to rest: about a half
/// in the laboratory scene and on the wide stacks of chapter 5.
constexpr double woken_share = 0.5;

/// Work of an update where snow has flown apart in clumps, each with grid blocks of its own, over
/// that in a slab: 13 to 16 in 3D after 125 m. A particle all alone takes 40.
constexpr double scattered_snow(int dimension) { return dimension == 2 ? 4.0 : 15.0; }

double nodes_per_block(const Scene& scene) {
  return scene.dimension == 2 ? block_nodes<2> : block_nodes<3>;
}

/// Nodes of the grid blocks around the snow of an event, were each body compact: many small bodies
/// far apart use more of them than the volume of their snow tells.
double count_nodes(const Scene& scene, int event) {
  constexpr double reached = 1.5;  // blocks beyond its own that the splines of a body reach
  const double edge = (scene.dimension == 2 ? block_edge<2> : block_edge<3>)*scene.mpm().dx;
  double blocks = 0;
  for (const BodySpec& body : assemble_bodies(scene, event)) {
    const double volume = shape_volume(body.shape, scene.dimension).value_or(0.0);
    const double size = std::pow(volume, 1.0 / scene.dimension) / edge;
    blocks += std::pow(size + reached, scene.dimension);
  }
  return blocks * nodes_per_block(scene);
}

/// How many obstacles overlap where most do: their boxes are counted at the middles of some.
double most_overlapping(const std::vector<ObstacleSpec>& obstacles) {
  constexpr std::size_t places = 200;
  std::vector<Eigen::AlignedBox3d> boxes;
  double everywhere = 0;
  for (const ObstacleSpec& o : obstacles) {
    const auto bounds = shape_bounds(o.shape);
    if (bounds && bounds->sizes().allFinite())
      boxes.push_back(*bounds);
    else
      ++everywhere;
  }
  std::size_t most = 0;
  const std::size_t stride = std::max<std::size_t>(1, boxes.size() / places);
  for (std::size_t i = 0; i < boxes.size(); i += stride)
    most = std::max(most, std::size_t(std::count_if(boxes.begin(), boxes.end(), [&](const auto& b) {
                      return b.contains(boxes[i].center());
                    })));
  return everywhere + double(most);
}

/// Memory of the grid where snow is scattered, and of the obstacles and the contacts with them.
double surroundings_bytes(const Scene& scene, double nodes) {
  const std::vector<ObstacleSpec> obstacles = assemble_obstacles(scene);
  const auto [per_contact, per_obstacle] = obstacle_storage(scene.mpm().precision);
  return nodes * most_overlapping(obstacles) * per_contact +
         per_obstacle * double(obstacles.size());
}

double snow_volume(const Scene& scene, int event) {
  double volume = 0.0;
  for (const auto& body : assemble_bodies(scene, event))
    volume += shape_volume(body.shape, scene.dimension).value_or(0.0);
  return volume;
}

/// Mean acceleration down the panel, from gravity less friction.
double slide_acceleration(const Scene& scene) {
  if (scene.panel->condition == Condition::sticky) return 0.0;
  const PanelFrame frame = panel_frame(scene);
  const double sine = -frame.slope.z(), cosine = frame.normal.z();
  return std::max(0.0, scene.gravity * (sine - scene.panel->friction * cosine));
}

/// Whether there is anything for snow to land on, at about the height of the ground.
bool has_floor(const Scene& scene) {
  return scene.ground || scene.terrain || scene.domain || !scene.obstacles.empty();
}

/// Time to fall `height` (measured vertically) with a downward velocity relative to the ground.
double fall_duration(const Scene& scene, double height, double downward) {
  if (!has_floor(scene)) return std::numeric_limits<double>::infinity();
  if (height <= 0.0) return 0.0;
  const double root = std::sqrt(downward * downward + 2.0 * scene.gravity * height);
  return downward + root > 0.0 ? 2.0 * height / (downward + root)  // no cancellation
                               : std::numeric_limits<double>::infinity();
}

/// How fast a velocity brings a point nearer to the ground below it; the height is linear.
double approach(const Scene& scene, const Vec3& velocity) {
  return -height_above_ground(scene, velocity);
}

/// Way of what falls from a speed for a time, at most.
double falling_way(const Scene& scene, double speed, double time) {
  return time * (speed + scene.gravity * time / 2.0);
}

/// The way of the slab's rear within the time limit, and how far a slab that never lands flies
/// apart: its front falls freely while its rear still slides.
void add_flight(const Scene& scene, double front_slides, CostEstimate& estimate) {
  const double slides = std::min(estimate.slide_time, scene.events.max_time);
  const double falls = std::min(estimate.fall_time, scene.events.max_time - slides);
  const double acceleration = slide_acceleration(scene);
  estimate.way =
      acceleration * slides * slides / 2.0 + falling_way(scene, acceleration * slides, falls);
  if (std::isfinite(estimate.fall_time)) return;
  const double apart = scene.gravity * std::max(0.0, slides - front_slides) * falls;
  estimate.scattering = std::min(1.0 + apart / scene.slab->length, scattered_snow(scene.dimension));
}

/// The slab's rear slides off the lower edge and falls freely.
void add_slab(const Scene& scene, CostEstimate& estimate) {
  const PanelFrame frame = panel_frame(scene);
  const double distance = (scene.panel->length + scene.slab->length) / 2.0;
  const double acceleration = slide_acceleration(scene);
  estimate.slides = acceleration > 0.0;
  if (!estimate.slides) return;
  estimate.slide_time = std::sqrt(2.0 * distance / acceleration);
  const Vec3 velocity = acceleration * estimate.slide_time * frame.slope;
  estimate.fall_time = fall_duration(scene, scene.panel->height, approach(scene, velocity));

  const double ahead = std::max(0.0, (scene.panel->length - scene.slab->length) / 2.0);
  const double front_slides = std::sqrt(2.0 * ahead / acceleration);
  const Vec3 front_velocity = acceleration * front_slides * frame.slope;
  estimate.first_landing =
      front_slides + fall_duration(scene, scene.panel->height, approach(scene, front_velocity));
  add_flight(scene, front_slides, estimate);
}

/// Speed of what falls last when it lands, over gravity.
double time_to_lose_speed(const Scene& scene, const CostEstimate& estimate) {
  if (!(scene.gravity > 0.0) || !estimate.slides) return 0.0;
  const double along = slide_acceleration(scene) * estimate.slide_time;
  return std::sqrt(along * along + 2.0 * scene.gravity * scene.panel->height) / scene.gravity;
}

double add_bodies(const Scene& scene, CostEstimate& estimate) {
  double longest = 0.0;
  for (const auto& body : scene.bodies) {
    const auto bounds = shape_bounds(body.shape);
    if (!bounds) continue;
    const double height = height_above_ground(scene, bounds->center());
    const double falls = fall_duration(scene, height, approach(scene, body.velocity));
    const double way =
        falling_way(scene, body.velocity.norm(), std::min(falls, scene.events.max_time));
    estimate.way = std::max(estimate.way, way);
    longest = std::max(longest, falls);
  }
  return longest;
}

void add_times(const Scene& scene, CostEstimate& estimate) {
  if (scene.slab) add_slab(scene, estimate);
  const double bodies = add_bodies(scene, estimate);
  const double slab = estimate.slide_time + estimate.fall_time;
  if (bodies > slab) estimate.fall_time = bodies;
  if (!scene.bodies.empty()) estimate.first_landing = 0.0;
  const double settling = std::max(least_settling_time, time_to_lose_speed(scene, estimate));
  estimate.event_time = std::min(std::max(slab, bodies) + settling, scene.events.max_time);
}

/// New snow is awake from its release to rest, older snow in part, once something lands on it.
double count_updates(const Scene& scene, const CostEstimate& estimate) {
  double old_awake = 1.0;
  if (scene.mpm().sleep_speed > 0.0)
    old_awake = woken_share * std::max(0.0, 1.0 - estimate.first_landing / estimate.event_time);
  double particles = 0.0, old = 0.0;
  for (double fresh : estimate.particles) {
    particles += fresh + old_awake * old;
    old += fresh;
  }
  return particles * estimate.steps / scene.events.count;
}

/// Time over the step at rest, and more for the way: a step gets shorter with speed, as in
/// `next_time_step`.
double steps_per_event(const Scene& scene, const CostEstimate& estimate) {
  const MpmSettings& n = scene.mpm();
  return std::ceil(estimate.event_time / estimate.time_step +
                   2.0 * estimate.way / (n.dx * n.courant_factor));
}

std::vector<double> count_particles(const Scene& scene) {
  std::vector<double> counts;
  const double voxel = std::pow(scene.mpm().dx, scene.dimension);
  for (int event = 1; event <= scene.events.count; ++event)
    counts.push_back(
        std::round(snow_volume(scene, event) / voxel * scene.seeding.particles_per_voxel));
  return counts;
}

/// Of elastic waves of compression, m/s.
double wave_speed(const Snow& snow) {
  const auto elastic = Elasticity<double>::from(snow.youngs_modulus, snow.poissons_ratio, 3);
  return std::sqrt((elastic.lambda + 2.0 * elastic.mu) / snow.density);
}

std::string gigabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GB", bytes / 1e9);
  return text;
}

/// What the length of a step follows from.
std::string path_of_step(const Scene& scene) {
  if (scene.uses<SlideSettings>())
    return path_of(scene, std::get<SlideSettings>(scene.numerics).time_step);
  if (scene.uses<GrainsSettings>())
    return path_of(scene, std::get<GrainsSettings>(scene.numerics).courant_factor);
  if (scene.uses<MpmSettings>()) return path_of(scene, scene.mpm().courant_factor);
  const MpsSettings& mps = std::get<MpsSettings>(scene.numerics);
  // The Courant factor shortens the steps that max_time_step allows.
  const bool allowed = mps.max_time_step < mps.courant_factor * mps.spacing;
  return path_of(scene, allowed ? mps.max_time_step : mps.courant_factor);
}

}  // namespace

double stable_time_step(const Scene& scene) {
  double limit = std::numeric_limits<double>::infinity();
  const MpmSettings& n = scene.mpm();
  for (const Snow& snow : assemble_snows(scene))
    limit =
        std::min(limit, elastic_time_step(snow.youngs_modulus, snow.poissons_ratio, snow.density,
                                          scene.dimension, n.dx, n.transfer, n.basis));
  return next_time_step(limit, 0.0, n.dx, n.courant_factor);
}

CostEstimate estimate_cost(const Scene& scene) {
  return estimate_cost(scene, count_particles(resolve(scene)));
}

CostEstimate estimate_cost(const Scene& given, std::vector<double> particles) {
  const Scene scene = resolve(given);
  CostEstimate estimate;
  estimate.total_particles = std::accumulate(particles.begin(), particles.end(), 0.0);
  estimate.particles = std::move(particles);
  for (const Snow& snow : assemble_snows(scene))
    estimate.wave_speed = std::max(estimate.wave_speed, wave_speed(snow));
  estimate.time_step = stable_time_step(scene);
  add_times(scene, estimate);
  estimate.steps = scene.events.count * steps_per_event(scene, estimate);
  estimate.updates = count_updates(scene, estimate);
  const auto [per_particle, per_voxel] = storage(scene.dimension, scene.mpm().precision);
  double nodes = 0;
  for (int event = 1; event <= scene.events.count; ++event) nodes += count_nodes(scene, event);
  const double filled = grid_spread * estimate.total_particles / scene.seeding.particles_per_voxel;
  const double voxels = std::max(filled, nodes);
  estimate.bytes = per_particle * estimate.total_particles + per_voxel * voxels +
                   surroundings_bytes(scene, voxels);
  return estimate;
}

void check_memory(double bytes, double available) {
  if (bytes > available)
    throw InputError("/", "needs " + gigabytes(bytes) + " of memory, of which there are " +
                              gigabytes(available) + "; give fewer particles or a larger dx");
}

void check_duration(const Scene& scene, const CostEstimate& cost) {
  constexpr double most_steps = 1e12, most_records = 1e6;
  const double steps = cost.event_time / cost.time_step;
  if (!(steps <= most_steps))
    throw InputError(path_of_step(scene), "makes steps of " + show_rounded(cost.time_step) +
                                              " s, of which an event of " +
                                              show_rounded(cost.event_time) + " s would take " +
                                              show_rounded(steps) + "; at most 1e12 are allowed");
  const auto check_interval = [&](const double& interval) {
    const double records = cost.event_time * scene.events.count / interval;
    if (interval > 0 && !(records <= most_records))
      throw InputError(path_of(scene, interval), show(interval) + " s makes " +
                                                     show_rounded(records) +
                                                     " records; at most 1e6 are allowed");
  };
  check_interval(scene.output.snapshot_interval);
  check_interval(scene.output.film_interval);
}

void check_memory(double bytes) {
  check_memory(bytes, static_cast<double>(physical_memory_bytes()));
}

}  // namespace snowshed
