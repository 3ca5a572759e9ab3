#include "snowshed/scene/effect_notes.hpp"

#include <algorithm>

#include "snowshed/core/message_format.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/panel_frame.hpp"
#include "snowshed/scene/shape_measure.hpp"
#include "snowshed/scene/writer.hpp"

namespace snowshed::scene {
namespace {

/// Farther from all snow, in sizes of it and its panel, an obstacle is probably in another unit.
constexpr double max_reach = 100;

template <class Part>
void add_notes_on_contact(const methods::MethodInfo& method, const std::string& path,
                          const Part& part, std::vector<std::string>& notes) {
  if (part.condition == methods::Condition::slip && !method.holds_slipping)
    notes.push_back(path + "/condition: \"slip\" acts as \"separate\", because the method " +
                    method.name + " lets snow leave any surface");
  if (part.condition == methods::Condition::sticky && part.friction != Part{}.friction)
    notes.push_back(path + "/friction: " + show(part.friction) + " is not used, because " + path +
                    "/condition is \"sticky\"");
}

void add_notes_on_contacts(const Scene& scene, std::vector<std::string>& notes) {
  const methods::MethodInfo& method = scene.numerics->info();
  if (scene.panel) add_notes_on_contact(method, "/panel", *scene.panel, notes);
  if (scene.ground) add_notes_on_contact(method, "/ground", *scene.ground, notes);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    add_notes_on_contact(method, "/obstacles/" + std::to_string(i), scene.obstacles[i], notes);
}

std::string shown_setting(const nlohmann::ordered_json& value) {
  return value.is_number() ? show(value.get<double>()) : value.dump();
}

/// The settings of a method by their keys.
nlohmann::ordered_json settings_of(methods::MethodChoice method, int dimension) {
  return Writer::write(method, dimension);
}

void add_notes_on_settings(const Scene& scene, std::vector<std::string>& notes) {
  const nlohmann::ordered_json settings = settings_of(scene.numerics, scene.dimension),
                               usual = settings_of(scene.numerics.usual(), scene.dimension);
  for (const methods::UnusedSettings& unused : scene.numerics->unused_settings(view_of(scene)))
    for (const std::string key : unused.settings)
      if (unused.applies && settings.contains(key) && settings[key] != usual[key])
        notes.push_back("/numerics/" + key + ": " + shown_setting(settings[key]) +
                        " is not used, because " + unused.because);
}

void add_notes_on_records(const methods::Output& output, std::vector<std::string>& notes) {
  if (!output.film && output.film_interval != methods::Output{}.film_interval)
    notes.push_back("/output/film_interval: " + show(output.film_interval) +
                    " s is not used, because /output/film is false");
  if (!output.forces && output.force_interval != methods::Output{}.force_interval)
    notes.push_back("/output/force_interval: " + show(output.force_interval) +
                    " s is not used, because /output/forces is false");
}

/// The box around all snow whose place needs no file, and around the panel; empty without any.
geometry::Bounds snow_bounds(const Scene& scene) {
  geometry::Bounds snow = geometry::empty_bounds();
  if (scene.panel)
    for (const Vec3& edge : {panel_frame(scene).lower_edge(), panel_frame(scene).upper_edge()})
      snow = geometry::united_bounds(snow, {edge, edge});
  for (const BodySpec& body : scene.bodies)
    if (const auto box = shape_bounds(body.shape))
      snow = geometry::united_bounds(snow, {box->min(), box->max()});
  return snow;
}

/// The highest corner of a box above the ground, m.
double highest_corner(const Scene& scene, const geometry::Bounds& box) {
  const double x[] = {box.min.x(), box.max.x()};
  return std::max(height_above_ground(scene, {x[0], 0, box.max.z()}),
                  height_above_ground(scene, {x[1], 0, box.max.z()}));
}

/// The distance of two boxes along x or z, m; the larger of both.
double gap(const geometry::Bounds& a, const geometry::Bounds& b) {
  const Vec3 apart = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(Vec3::Zero());
  return std::max(apart.x(), apart.z());
}

void add_notes_on_places(const Scene& scene, const std::vector<methods::Obstacle>& obstacles,
                         std::vector<std::string>& notes) {
  const geometry::Bounds snow = snow_bounds(scene);
  const bool is_placed = !geometry::is_empty(snow) && geometry::is_finite(snow, 2);
  const Vec3 sizes = is_placed ? Vec3(snow.max - snow.min) : Vec3(Vec3::Zero());
  const double height = scene.panel ? scene.panel->height : 0;
  const double size = std::max({sizes.x(), sizes.z(), height});
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (scene.obstacles[i].motion) continue;  // it may come
    const geometry::Bounds box = obstacles[i].shape->bounds();
    if (!geometry::is_finite(box, 2)) continue;
    const std::string path = "/obstacles/" + std::to_string(i);
    if (scene.ground && highest_corner(scene, box) <= 0)
      notes.push_back(path + ": it lies below the ground, where no snow can meet it");
    else if (is_placed && gap(box, snow) > max_reach * size)
      notes.push_back(path + ": it lies " + show_briefly(gap(box, snow)) +
                      " m from panel and snow, which are " + show_briefly(size) +
                      " m large; check its unit");
  }
}

void add_notes_on_motions(const Scene& scene, std::vector<std::string>& notes) {
  const double end = scene.events.count * scene.events.max_time;
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const auto& motion = scene.obstacles[i].motion;
    if (motion && motion->start >= end)
      notes.push_back("/obstacles/" + std::to_string(i) + "/motion/start: " + show(motion->start) +
                      " s is after the end of the run, at most " + show_briefly(end) +
                      " s: the obstacle does not move");
  }
}

}  // namespace

void add_notes_on_effects(const Scene& scene, const std::vector<methods::Obstacle>& obstacles,
                          std::vector<std::string>& notes) {
  add_notes_on_settings(scene, notes);
  add_notes_on_contacts(scene, notes);
  add_notes_on_records(scene.output, notes);
  add_notes_on_places(scene, listed_obstacles(scene, obstacles), notes);
  add_notes_on_motions(scene, notes);
}

}  // namespace snowshed::scene
