#include "snowshed/run/motion_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "snowshed/scene/panel_frame.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed::run {
namespace {

/// From the last impact to rest, snow loses the speed of its fall at about the acceleration of
/// gravity: 0.2 to 0.35 s in the laboratory scene, 0.5 to 0.7 s where it falls from 2 m. This is
/// the least time that it took:
constexpr double min_settling_time = 0.25;  // s

/// Mean acceleration down the panel, from gravity less friction.
double sliding_acceleration(const scene::Scene& scene) {
  if (scene.panel->condition == methods::Condition::sticky) return 0.0;
  const scene::PanelFrame frame = scene::panel_frame(scene);
  const double sine = -frame.slope.z(), cosine = frame.normal.z();
  return std::max(0.0, scene.gravity * (sine - scene.panel->friction * cosine));
}

/// Whether the scene has a surface on which snow can land; its height is taken to be the ground's.
bool has_floor(const scene::Scene& scene) {
  return scene.ground || scene.terrain || scene.domain || !scene.obstacles.empty();
}

/// Time to fall `height` (measured vertically) with a downward velocity relative to the ground.
double fall_duration(const scene::Scene& scene, double height, double downward) {
  if (!has_floor(scene)) return std::numeric_limits<double>::infinity();
  if (height <= 0.0) return 0.0;
  const double root = std::sqrt(downward * downward + 2.0 * scene.gravity * height);
  return downward + root > 0.0 ? 2.0 * height / (downward + root)  // no cancellation
                               : std::numeric_limits<double>::infinity();
}

/// Speed at which a point with this velocity approaches the ground, measured vertically.
double approach(const scene::Scene& scene, const Vec3& velocity) {
  return -scene::height_above_ground(scene, velocity);
}

/// Upper bound of the distance of a fall, after a time, from an initial speed in any direction.
double falling_distance(const scene::Scene& scene, double speed, double time) {
  return time * (speed + scene.gravity * time / 2.0);
}

/// Adds the distance of the slab's rear within the time limit, and the stretch of a slab that never
/// lands: its front falls freely while its rear still slides.
void add_flight(const scene::Scene& scene, double front_slides, methods::SnowMotion& motion) {
  const double slides = std::min(motion.sliding_time, scene.events.max_time);
  const double falls = std::min(motion.fall_time, scene.events.max_time - slides);
  const double acceleration = sliding_acceleration(scene);
  motion.distance =
      acceleration * slides * slides / 2.0 + falling_distance(scene, acceleration * slides, falls);
  if (std::isfinite(motion.fall_time)) return;
  const double front_lead = scene.gravity * std::max(0.0, slides - front_slides) * falls;
  motion.stretch = 1.0 + front_lead / scene.slab->length;
}

/// The slab's rear slides off the lower edge and falls freely.
void add_slab(const scene::Scene& scene, methods::SnowMotion& motion) {
  const scene::PanelFrame frame = scene::panel_frame(scene);
  const double distance = (scene.panel->length + scene.slab->length) / 2.0;
  const double acceleration = sliding_acceleration(scene);
  motion.slides = acceleration > 0.0;
  if (!motion.slides) return;
  motion.sliding_time = std::sqrt(2.0 * distance / acceleration);
  const Vec3 velocity = acceleration * motion.sliding_time * frame.slope;
  motion.fall_time = fall_duration(scene, scene.panel->height, approach(scene, velocity));

  const double ahead = std::max(0.0, (scene.panel->length - scene.slab->length) / 2.0);
  const double front_slides = std::sqrt(2.0 * ahead / acceleration);
  const Vec3 front_velocity = acceleration * front_slides * frame.slope;
  motion.first_landing =
      front_slides + fall_duration(scene, scene.panel->height, approach(scene, front_velocity));
  add_flight(scene, front_slides, motion);
}

/// The speed at which the last snow lands, divided by gravity, s.
double time_to_lose_speed(const scene::Scene& scene, const methods::SnowMotion& motion) {
  if (!(scene.gravity > 0.0) || !motion.slides) return 0.0;
  const double along = sliding_acceleration(scene) * motion.sliding_time;
  return std::sqrt(along * along + 2.0 * scene.gravity * scene.panel->height) / scene.gravity;
}

/// Returns the longest fall of a body, s.
double add_bodies(const scene::Scene& scene, methods::SnowMotion& motion) {
  double longest = 0.0;
  for (const auto& body : scene.bodies) {
    const auto bounds = scene::shape_bounds(body.shape);
    if (!bounds) continue;
    const double height = scene::height_above_ground(scene, bounds->center());
    const double falls = fall_duration(scene, height, approach(scene, body.velocity));
    const double distance =
        falling_distance(scene, body.velocity.norm(), std::min(falls, scene.events.max_time));
    motion.distance = std::max(motion.distance, distance);
    longest = std::max(longest, falls);
  }
  return longest;
}

}  // namespace

methods::SnowMotion estimate_motion(const scene::Scene& scene) {
  methods::SnowMotion motion;
  if (scene.slab) add_slab(scene, motion);
  const double bodies = add_bodies(scene, motion);
  const double slab = motion.sliding_time + motion.fall_time;
  if (bodies > slab) motion.fall_time = bodies;
  if (!scene.bodies.empty()) motion.first_landing = 0.0;
  const double settling = std::max(min_settling_time, time_to_lose_speed(scene, motion));
  motion.event_time = std::min(std::max(slab, bodies) + settling, scene.events.max_time);
  return motion;
}

}  // namespace snowshed::run
