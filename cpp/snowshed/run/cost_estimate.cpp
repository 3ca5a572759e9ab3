#include "snowshed/run/cost_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/run/snow_motion.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/locator.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed {
namespace {

/// Largest number of obstacles that overlap at a point. Boxes are counted at the middles of some
/// obstacles.
double max_overlap(const std::vector<ObstacleSpec>& obstacles) {
  constexpr std::size_t sampled_boxes = 200;
  std::vector<Eigen::AlignedBox3d> boxes;
  double everywhere = 0;
  for (const ObstacleSpec& o : obstacles) {
    const auto bounds = shape_bounds(o.shape);
    if (bounds && bounds->sizes().allFinite())
      boxes.push_back(*bounds);
    else
      ++everywhere;
  }
  std::size_t max_overlaps = 0;
  const std::size_t stride = std::max<std::size_t>(1, boxes.size() / sampled_boxes);
  for (std::size_t i = 0; i < boxes.size(); i += stride)
    max_overlaps = std::max(
        max_overlaps, std::size_t(std::count_if(boxes.begin(), boxes.end(), [&](const auto& b) {
          return b.contains(boxes[i].center());
        })));
  return everywhere + double(max_overlaps);
}

/// The height of the snow of the first event, from its lowest point or z = 0 if that is lower, m.
double height_of(const Scene& scene) {
  double low = 0, high = 0;
  for (const BodySpec& body : assemble_bodies(scene, 1))
    if (const auto bounds = shape_bounds(body.shape)) {
      low = std::min(low, bounds->min().z());
      high = std::max(high, bounds->max().z());
    }
  return high - low;
}

std::string gigabytes(double bytes) { return show_briefly(bytes / 1e9) + " GB"; }

/// Particles in the volumes of each event.
std::vector<double> count_particles(const Scene& scene, const SceneOutline& outline) {
  std::vector<double> counts;
  const double voxel = std::pow(scene.numerics->resolution(), scene.dimension);
  for (const std::vector<double>& volumes : outline.volumes) {
    const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    counts.push_back(std::round(volume / voxel * outline.particles_per_voxel));
  }
  return counts;
}

CostEstimate estimate(const Scene& scene, const SceneOutline& outline,
                      std::vector<double> particles) {
  return scene.numerics->cost_of_bodies(view_of(scene), outline, std::move(particles));
}

}  // namespace

SceneOutline outline_of(const Scene& scene) {
  SceneOutline outline;
  outline.snows = assemble_snows(scene);
  for (int event = 1; event <= scene.events.count; ++event) {
    std::vector<double>& volumes = outline.volumes.emplace_back();
    for (const BodySpec& body : assemble_bodies(scene, event))
      volumes.push_back(shape_volume(body.shape, scene.dimension).value_or(0.0));
  }
  outline.particles_per_voxel = scene.seeding.particles_per_voxel;
  outline.height = height_of(scene);
  const std::vector<ObstacleSpec> obstacles = assemble_obstacles(scene);
  outline.conditions.resize(std::size(EnumNames<Condition>::list));
  for (const ObstacleSpec& o : obstacles) {
    outline.conditions[std::size_t(o.condition)] = true;
    outline.has_moving_obstacle = outline.has_moving_obstacle || o.motion.has_value();
  }
  outline.has_domain = scene.domain.has_value();
  outline.obstacles = double(obstacles.size());
  outline.max_overlap = max_overlap(obstacles);
  outline.motion = estimate_motion(scene);
  return outline;
}

CostEstimate estimate_cost(const Scene& given) {
  const Scene scene = resolve(given);
  const SceneOutline outline = outline_of(scene);
  return estimate(scene, outline, count_particles(scene, outline));
}

CostEstimate estimate_cost(const Scene& given, std::vector<double> particles) {
  const Scene scene = resolve(given);
  return estimate(scene, outline_of(scene), std::move(particles));
}

void check_memory(double bytes, double available) {
  if (bytes > available)
    throw InputError("/", "needs " + gigabytes(bytes) + " of memory; available are " +
                              gigabytes(available) + "; give fewer particles or a larger dx");
}

void check_duration(const Scene& scene, const CostEstimate& cost) {
  constexpr double max_steps = 1e12, max_records = 1e6;
  const double steps = cost.event_time / cost.time_step;
  if (!(steps <= max_steps))
    throw InputError("/numerics/" + scene.numerics->step_setting(),
                     "makes steps of " + show_rounded(cost.time_step) + " s; an event of " +
                         show_rounded(cost.event_time) + " s would take " + show_rounded(steps) +
                         " of them; at most 1e12 are allowed");
  const auto check_interval = [&](const double& interval) {
    const double records = cost.event_time * scene.events.count / interval;
    if (interval > 0 && !(records <= max_records))
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
