#include "snowshed/run/cost_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/run/motion_estimate.hpp"
#include "snowshed/scene/distinct_snows.hpp"
#include "snowshed/scene/event_bodies.hpp"
#include "snowshed/scene/locator.hpp"
#include "snowshed/scene/obstacle_specs.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed::run {
namespace {

/// Estimates the largest number of obstacles that overlap at a point: counts the bounding boxes
/// that contain the centres of some boxes.
double max_overlap(const std::vector<scene::ObstacleSpec>& obstacles) {
  constexpr std::size_t sampled_boxes = 200;
  std::vector<Eigen::AlignedBox3d> boxes;
  double everywhere = 0;
  for (const scene::ObstacleSpec& o : obstacles) {
    const auto bounds = scene::shape_bounds(o.shape);
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

/// Height of the first event's snow above its lowest point, or above z = 0 if that is lower, m.
double height_of(const scene::Scene& scene) {
  double low = 0, high = 0;
  for (const scene::BodySpec& body : scene::event_bodies(scene, 1))
    if (const auto bounds = scene::shape_bounds(body.shape)) {
      low = std::min(low, bounds->min().z());
      high = std::max(high, bounds->max().z());
    }
  return high - low;
}

std::string gigabytes(double bytes) { return show_briefly(bytes / 1e9) + " GB"; }

/// Particles in the volumes of each event.
std::vector<double> count_particles(const scene::Scene& scene,
                                    const methods::SceneOutline& outline) {
  std::vector<double> counts;
  const double voxel = std::pow(scene.numerics->resolution(), scene.dimension);
  for (const std::vector<double>& volumes : outline.volumes) {
    const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    counts.push_back(std::round(volume / voxel * outline.particles_per_voxel));
  }
  return counts;
}

methods::CostEstimate estimate(const scene::Scene& scene, const methods::SceneOutline& outline,
                               std::vector<double> particles) {
  return scene.numerics->cost_of_bodies(scene::view_of(scene), outline, std::move(particles));
}

}  // namespace

methods::SceneOutline outline_of(const scene::Scene& scene) {
  methods::SceneOutline outline;
  outline.snows = scene::distinct_snows(scene);
  for (int event = 1; event <= scene.events.count; ++event) {
    std::vector<double>& volumes = outline.volumes.emplace_back();
    for (const scene::BodySpec& body : scene::event_bodies(scene, event))
      volumes.push_back(scene::shape_volume(body.shape, scene.dimension).value_or(0.0));
  }
  outline.particles_per_voxel = scene.seeding.particles_per_voxel;
  outline.height = height_of(scene);
  const std::vector<scene::ObstacleSpec> obstacles = scene::obstacle_specs(scene);
  outline.conditions.resize(std::size(methods::EnumNames<methods::Condition>::list));
  for (const scene::ObstacleSpec& o : obstacles) {
    outline.conditions[std::size_t(o.condition)] = true;
    outline.has_moving_obstacle = outline.has_moving_obstacle || o.motion.has_value();
  }
  outline.has_domain = scene.domain.has_value();
  outline.obstacles = double(obstacles.size());
  outline.max_overlap = max_overlap(obstacles);
  outline.motion = estimate_motion(scene);
  return outline;
}

methods::CostEstimate estimate_cost(const scene::Scene& given) {
  const scene::Scene scene = scene::resolve(given);
  const methods::SceneOutline outline = outline_of(scene);
  return estimate(scene, outline, count_particles(scene, outline));
}

methods::CostEstimate estimate_cost(const scene::Scene& given, std::vector<double> particles) {
  const scene::Scene scene = scene::resolve(given);
  return estimate(scene, outline_of(scene), std::move(particles));
}

void check_memory(double bytes, double available) {
  if (bytes > available)
    throw InputError("/", "needs " + gigabytes(bytes) + " of memory; available are " +
                              gigabytes(available) + "; give fewer particles or a larger dx");
}

void check_duration(const scene::Scene& scene, const methods::CostEstimate& cost) {
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
      throw InputError(scene::path_of(scene, interval), show(interval) + " s makes " +
                                                            show_rounded(records) +
                                                            " records; at most 1e6 are allowed");
  };
  check_interval(scene.output.snapshot_interval);
  check_interval(scene.output.film_interval);
}

void check_memory(double bytes) {
  check_memory(bytes, static_cast<double>(physical_memory_bytes()));
}

}  // namespace snowshed::run
