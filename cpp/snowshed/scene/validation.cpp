#include "snowshed/scene/validation.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "snowshed/methods/registry.hpp"
#include "snowshed/scene/distinct_snows.hpp"
#include "snowshed/scene/event_bodies.hpp"
#include "snowshed/scene/locator.hpp"
#include "snowshed/scene/obstacle_specs.hpp"
#include "snowshed/scene/panel_frame.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed::scene {
namespace {

class SceneRules {
 public:
  explicit SceneRules(const Scene& scene) : scene_(scene) {}

  void check() const {
    check_parts(scene_, scene_.numerics->info());
    if (scene_.domain) check_domain(*scene_.domain);
    if (scene_.panel) check_panel(*scene_.panel);
    if (scene_.slab) check_slab(*scene_.slab);
    check_number_of_shapes();
    for (const auto& obstacle : scene_.obstacles) check_obstacle(obstacle);
    check_names();
    for (const auto& body : scene_.bodies) check_body(body);
    check_snows();
    check_seeding(scene_.seeding);
    check_snow_and_events();
    if (scene_.events.rest_time > scene_.events.max_time)
      fail(scene_.events.rest_time, show(scene_.events.rest_time) + " s is longer than an event (" +
                                        path_and_value(scene_.events.max_time) + " s)");
    if (scene_.terrain) check_terrain(*scene_.terrain);
    scene_.numerics->validate(view_of(scene_));
    if (scene_.numerics.takes(methods::Part::bodies) && !scene_.slab && scene_.bodies.empty())
      fail(scene_, "there is no snow; give " + path_of(scene_, scene_.slab) + " or " +
                       path_of(scene_, scene_.bodies));
  }

 private:
  template <class T>
  [[noreturn]] void fail(const T& member, const std::string& message) const {
    throw InputError(path_of(scene_, member), message);
  }

  /// Returns path and value of a member, such as "/panel/length = 2".
  std::string path_and_value(const double& member) const {
    return path_of(scene_, member) + " = " + show(member);
  }

  bool in_3d() const { return scene_.dimension == 3; }

  void check_domain(const Domain& domain) const {
    for (const int i : {0, 1, 2}) {
      if (i == 1 && !in_3d()) continue;
      if (domain.max[i] <= domain.min[i])
        fail(domain.max, std::string(1, "xyz"[i]) + " = " + show(domain.max[i]) +
                             " must be above " + path_of(scene_, domain.min) + ", " +
                             show(domain.min[i]));
    }
  }

  void check_slab(const Slab& slab) const {
    if (!scene_.panel) fail(slab, "there is no " + path_of(scene_, scene_.panel) + " to lie on");
    check_fits(slab.length, scene_.panel->length, "longer");
    if (in_3d()) check_fits(slab.width, scene_.panel->width, "wider");
    check_layers(slab);
    check_in_domain(slab, thickest_slab());
  }

  void check_layers(const Slab& slab) const {
    if (slab.layers.empty() && slab.thickness == 0.0)
      fail(slab.thickness,
           "missing: a thickness, or " + path_of(scene_, slab.layers) + ", is required");
    if (!slab.layers.empty() && slab.thickness > 0.0)
      fail(slab.thickness, show(slab.thickness) + " m and " + path_of(scene_, slab.layers) +
                               " are both given; the slab is as thick as its layers together");
    for (const auto& layer : slab.layers) check_event(layer.event);
  }

  /// Returns the slab of the event in which it is thickest, as one solid.
  ShapeSpec thickest_slab() const {
    const auto& layers = scene_.slab->layers;
    double always = scene_.slab->thickness;
    std::map<int, double> of_event;
    for (const auto& layer : layers) {
      double& thickness = layer.event == 0 ? always : of_event[layer.event];
      thickness += layer.thickness;
    }
    double max_thickness = 0.0;
    for (const auto& [event, thickness] : of_event)
      max_thickness = std::max(max_thickness, thickness);
    Scene single_layer = scene_;
    single_layer.slab->layers.clear();
    single_layer.slab->thickness = always + max_thickness;
    return slab_bodies(single_layer, 1).front().shape;
  }

  void check_event(const int& event) const {
    if (event > scene_.events.count)
      fail(event, show(event) + " is beyond the last event (" +
                      path_of(scene_, scene_.events.count) + " = " + show(scene_.events.count) +
                      ")");
  }

  void check_snows() const {
    const std::size_t snows = distinct_snows(scene_).size();
    if (snows > material::max_materials)
      fail(scene_, std::to_string(snows) + " different snows in slab and bodies; at most " +
                       std::to_string(material::max_materials) + " are allowed");
  }

  void check_fits(const double& slab, const double& panel, const std::string& longer) const {
    if (slab > panel)
      fail(slab,
           show(slab) + " m is " + longer + " than the panel (" + path_and_value(panel) + " m)");
  }

  void check_panel(const Panel& panel) const {
    const double height = height_above_ground(scene_, panel_frame(scene_).upper_edge());
    if (height < 0.0)
      fail(panel.tilt, show(panel.tilt) + " degrees put the upper edge " + show_rounded(-height) +
                           " m below the ground, which is steeper");
  }

  /// A shape written with its defaults takes up to 13 values, snow fewer. The written scene must
  /// stay within the parser's limit (max_values); otherwise its run could not be resumed.
  void check_number_of_shapes() const {
    constexpr std::size_t max_shapes = 50'000;
    std::size_t shapes = 0;
    for (const auto& obstacle : scene_.obstacles) shapes += count(obstacle.shape);
    for (const auto& body : scene_.bodies) shapes += count(body.shape) + body.snow.has_value();
    if (shapes > max_shapes)
      fail(scene_, std::to_string(shapes) + " shapes in all; at most " +
                       std::to_string(max_shapes) + " are allowed");
  }

  static std::size_t count(const ShapeSpec& shape) {
    std::size_t shapes = 1;
    for (const auto& part : shape.shapes) shapes += count(part);
    return shapes;
  }

  void check_obstacle(const ObstacleSpec& obstacle) const {
    check_shape(obstacle.shape, 1);
    if (obstacle.motion && obstacle.motion->end < obstacle.motion->start)
      fail(obstacle.motion->end, show(obstacle.motion->end) + " s is before the start (" +
                                     path_and_value(obstacle.motion->start) + " s)");
  }

  /// Names must differ, because results identify obstacles by them.
  void check_names() const {
    std::set<std::string> names;
    for (const auto& obstacle : obstacle_specs(scene_)) {
      if (obstacle.name.empty() || names.insert(obstacle.name).second) continue;
      const auto last = std::find_if(
          scene_.obstacles.rbegin(), scene_.obstacles.rend(),
          [&](const ObstacleSpec& candidate) { return candidate.name == obstacle.name; });
      fail(last->name, quote(obstacle.name) + " is already the name of another obstacle");
    }
  }

  void check_body(const BodySpec& body) const {
    check_shape(body.shape, 1);
    const auto bounds = shape_bounds(body.shape);
    if (bounds && !bounds->sizes().allFinite())
      fail(body.shape, "an unbounded shape cannot be filled with snow");
    check_in_domain(body.shape, body.shape);
    check_event(body.event);
    if (body.volume > 0 && !scene_.numerics.takes(methods::Part::seeding))
      fail(body.volume, "the method " + quote(scene_.numerics->info().name) +
                            " takes the volume of the solid; leave this one out");
  }

  /// Checks that the method supports the scene's snow, events and output.
  void check_snow_and_events() const {
    const methods::MethodInfo& method = scene_.numerics->info();
    const std::string name = "the method " + quote(method.name);
    const auto refuse_own = [&](const auto& part) {
      if (part.snow && !method.takes.has(methods::Part::snow))
        fail(*part.snow, name + " takes the snow of its settings");
    };
    for (const BodySpec& body : scene_.bodies) refuse_own(body);
    if (scene_.slab)
      for (const Layer& layer : scene_.slab->layers) refuse_own(layer);
    const bool reseeds =
        scene_.events.between == methods::Between::reseed && scene_.events.count > 1;
    if (reseeds && method.takes.has(methods::Part::bodies) &&
        !method.takes.has(methods::Part::seeding))
      fail(scene_.events.between, name + " does not support \"reseed\"; use \"carry\"");
    if (scene_.output.energy && method.energies.empty())
      fail(scene_.output.energy, name + " has no energy balance");
    if (scene_.output.forces && !method.records_forces)
      fail(scene_.output.forces, name + " records no forces on obstacles");
  }

  void check_terrain(const methods::TerrainSpec& terrain) const {
    const bool from_map = !terrain.thickness_file.empty();
    for (const methods::AreaSpec& area : terrain.release) {
      check_area(area);
      if (!from_map) check_thickness(area, terrain);
    }
    for (const methods::AreaSpec& area : terrain.secondary_release) {
      check_area(area);
      check_thickness(area, terrain);
    }
    for (const methods::InflowSpec& inflow : terrain.inflows) {
      check_area(inflow);
      for (const methods::PulseSpec& pulse : inflow.hydrograph) check_thickness(pulse, terrain);
    }
    for (const methods::AreaSpec& area : terrain.entrainment) {
      check_area(area);
      check_thickness(area, terrain);
    }
    for (const methods::ResistanceSpec& area : terrain.resistance) check_area(area);
  }

  template <class Snow>
  void check_thickness(const Snow& area, const methods::TerrainSpec& terrain) const {
    if (area.thickness > terrain.max_thickness)
      fail(area.thickness, show(area.thickness) + " m of snow; at most " +
                               show(terrain.max_thickness) +
                               " m are accepted; is it in centimetres? If not, raise " +
                               path_of(scene_, terrain.max_thickness));
  }

  template <class Area>
  void check_area(const Area& area) const {
    check_ring(area.outline);
    for (const methods::HoleSpec& hole : area.holes) check_ring(hole.outline);
  }

  void check_ring(const geometry::Ring& ring) const {
    if (geometry::twice_signed_area(ring) == 0.0) fail(ring, "encloses no area");
    if (geometry::crosses_itself(ring)) fail(ring, "crosses or touches itself");
  }

  template <class T>
  void check_in_domain(const T& member, const ShapeSpec& shape) const {
    const auto bounds = shape_bounds(shape);
    if (!scene_.domain || !bounds) return;
    const double rounding = 1e-6 * scene_.numerics->resolution();
    for (const int i : {0, 1, 2}) {
      if (i == 1 && !in_3d()) continue;
      const double low = scene_.domain->min[i], high = scene_.domain->max[i];
      if (bounds->min()[i] < low - rounding || bounds->max()[i] > high + rounding)
        fail(member, std::string("its snow reaches from ") + "xyz"[i] + " = " +
                         show_rounded(bounds->min()[i]) + " to " + show_rounded(bounds->max()[i]) +
                         " m, beyond the domain (" + show(low) + " to " + show(high) + " m)");
    }
  }

  void check_shape(const ShapeSpec& shape, int depth) const {
    constexpr int max_depth = 16;  // far below the limits of the JSON parser and of any stack
    if (depth > max_depth)
      fail(shape, "shapes are nested more than " + std::to_string(max_depth) + " deep");
    const bool has_axis = shape.type == "cylinder" || shape.type == "capsule";
    if (has_axis && shape.from == shape.to)
      fail(shape.to, "must differ from " + path_of(scene_, shape.from));
    if (shape.type == "plate" && Vec3::UnitY().cross(shape.normal).norm() == 0.0)
      fail(shape.normal, "a plate facing along y has no slope");
    for (const auto& part : shape.shapes) check_shape(part, depth + 1);
  }

  void check_seeding(const methods::Seeding& seeding) const {
    const double given = seeding.particles_per_voxel;
    const double min_count = in_3d() ? 6.0 : 4.0;  // thesis A.3.2
    if (given != 0.0 && given < min_count && !seeding.allow_sparse)
      fail(seeding.particles_per_voxel, show(given) + " is too few in " + (in_3d() ? "3D" : "2D") +
                                            ": give at least " + show(min_count) +
                                            ", 0 for the default, or set " +
                                            path_of(scene_, seeding.allow_sparse));
  }

  const Scene& scene_;
};

}  // namespace

void check_parts(const Scene& scene, const methods::MethodInfo& method) {
  const auto check = [&](const auto& part, bool given, methods::Part kind) {
    if (given && !method.takes.has(kind))
      throw InputError(path_of(scene, part), methods::takes_no_part(method, kind));
  };
  check(scene.panel, scene.panel.has_value(), methods::Part::panel);
  check(scene.slab, scene.slab.has_value(), methods::Part::slab);
  check(scene.ground, scene.ground.has_value(), methods::Part::ground);
  check(scene.obstacles, !scene.obstacles.empty(), methods::Part::obstacles);
  check(scene.bodies, !scene.bodies.empty(), methods::Part::bodies);
  check(scene.domain, scene.domain.has_value(), methods::Part::domain);
  check(scene.terrain, scene.terrain.has_value(), methods::Part::terrain);
  check(scene.sample, scene.sample.has_value(), methods::Part::sample);
  check(scene.loading, !scene.loading.empty(), methods::Part::sample);
  check(scene.cone, scene.cone.has_value(), methods::Part::sample);
}

void check_rules(const Scene& scene) { SceneRules(scene).check(); }

}  // namespace snowshed::scene
