#include "snowshed/scene/validation.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/locator.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed {
namespace {

class SceneRules {
 public:
  explicit SceneRules(const Scene& scene) : scene_(scene) {}

  void check() const {
    check_parts(scene_, info_of(scene_.numerics));
    if (scene_.domain) check_domain(*scene_.domain);
    if (scene_.panel) check_panel(*scene_.panel);
    if (scene_.slab) check_slab(*scene_.slab);
    check_number_of_shapes();
    for (const auto& obstacle : scene_.obstacles) check_obstacle(obstacle);
    check_names();
    for (const auto& body : scene_.bodies) check_body(body);
    check_snows();
    check_seeding(scene_.seeding);
    if (scene_.uses<MpmSettings>()) check_damping(scene_.mpm());
    if (scene_.uses<MpsSettings>()) check_mps();
    if (scene_.events.rest_time > scene_.events.max_time)
      fail(scene_.events.rest_time, show(scene_.events.rest_time) + " s is longer than an event (" +
                                        path_and_value(scene_.events.max_time) + " s)");
    if (scene_.terrain) check_terrain(*scene_.terrain);
    if (scene_.uses<SlideSettings>()) return check_slide();
    if (scene_.uses<GrainsSettings>()) return check_grains();
    if (!scene_.slab && scene_.bodies.empty())
      fail(scene_, "nothing holds snow: give " + path_of(scene_, scene_.slab) + " or " +
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
    check_fits(slab.length, scene_.panel->length);
    if (in_3d()) check_fits(slab.width, scene_.panel->width);
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
    double most = 0.0;
    for (const auto& [event, thickness] : of_event) most = std::max(most, thickness);
    Scene whole = scene_;
    whole.slab->layers.clear();
    whole.slab->thickness = always + most;
    return assemble_slab(whole, 1).front().shape;
  }

  void check_event(const int& event) const {
    if (event > scene_.events.count)
      fail(event, show(event) + " is beyond the last event (" +
                      path_of(scene_, scene_.events.count) + " = " + show(scene_.events.count) +
                      ")");
  }

  void check_snows() const {
    const std::size_t snows = assemble_snows(scene_).size();
    if (snows > max_materials)
      fail(scene_, std::to_string(snows) + " different snows in slab and bodies; at most " +
                       std::to_string(max_materials) + " are allowed");
  }

  void check_fits(const double& slab, const double& panel) const {
    if (slab > panel)
      fail(slab, show(slab) + " m is more than the panel has (" + path_and_value(panel) + " m)");
  }

  void check_panel(const Panel& panel) const {
    const double height = height_above_ground(scene_, panel_frame(scene_).upper_edge());
    if (height < 0.0)
      fail(panel.tilt, show(panel.tilt) + " degrees put the upper edge " + show_rounded(-height) +
                           " m below the ground, which is steeper");
  }

  /// A shape written with its defaults takes up to 13 values, snow fewer. The written scene must
  /// stay within what the JSON parser reads (max_values), or its run could not be resumed.
  void check_number_of_shapes() const {
    constexpr std::size_t most = 50'000;
    std::size_t shapes = 0;
    for (const auto& obstacle : scene_.obstacles) shapes += count(obstacle.shape);
    for (const auto& body : scene_.bodies) shapes += count(body.shape) + body.snow.has_value();
    if (shapes > most)
      fail(scene_, std::to_string(shapes) + " shapes in all; at most " + std::to_string(most) +
                       " are allowed");
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

  /// Names must differ, because results tell obstacles apart by them.
  void check_names() const {
    std::set<std::string> names;
    for (const auto& obstacle : assemble_obstacles(scene_)) {
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
  }

  void check_slide() const {
    const SlideSettings& s = std::get<SlideSettings>(scene_.numerics);
    if (!scene_.terrain) fail(scene_, "a slide needs a " + path_of(scene_, scene_.terrain));
    if (!in_3d()) fail(scene_.dimension, "a slide moves over ground in space; allowed: 3");
    if (scene_.events.count != 1)
      fail(scene_.events.count, show(scene_.events.count) + " events; a slide has 1");
    if (scene_.terrain && !scene_.terrain->thickness_file.empty() &&
        s.mode == SlideMode::compatible)
      fail(scene_.terrain->thickness_file, "AvaFrame's com5SnowSlide takes no such raster");
    if (s.explicit_friction && s.mode != SlideMode::compatible)
      fail(s.explicit_friction, "only in the mode \"compatible\"");
  }

  void check_grains() const {
    if (!scene_.sample) fail(scene_, "grains need a " + path_of(scene_, scene_.sample));
    if (scene_.loading.empty())
      fail(scene_.loading,
           "a sample is loaded in at least one stage, such as {\"kind\": "
           "\"compress\"}");
    if (!in_3d()) fail(scene_.dimension, "grains move in space; allowed: 3");
    if (scene_.events.count != 1)
      fail(scene_.events.count, show(scene_.events.count) + " events; a loading is 1");
    check_loading();
    const auto pushed_in = [](const LoadingStage& s) { return s.kind == LoadingKind::penetrate; };
    if (scene_.cone && std::none_of(scene_.loading.begin(), scene_.loading.end(), pushed_in))
      fail(*scene_.cone, "no stage pushes it in; give one of the kind \"penetrate\"");
  }

  /// The snow of MPS is that of its settings.
  void check_mps() const {
    const MpsSettings& s = std::get<MpsSettings>(scene_.numerics);
    const auto refuse = [&](const auto& part) {
      if (part.snow) fail(*part.snow, "the method \"mps\" takes the snow of its settings");
    };
    for (const BodySpec& body : scene_.bodies) refuse(body);
    if (scene_.slab)
      for (const Layer& layer : scene_.slab->layers) refuse(layer);
    if (scene_.events.between == Between::reseed && scene_.events.count > 1)
      fail(scene_.events.between, "snow of the method \"mps\" can only be carried on");
    if (s.erosion && s.deposition_pressure >= s.erosion_pressure)
      fail(s.deposition_pressure, show(s.deposition_pressure) + " Pa must be less than " +
                                      path_and_value(s.erosion_pressure));
    if (s.erosion && s.deposition_speed >= s.erosion_speed)
      fail(s.deposition_speed,
           show(s.deposition_speed) + " m/s must be less than " + path_and_value(s.erosion_speed));
    if (s.order == MpsOrder::published && s.splitting == MpsSplitting::pressure_first)
      fail(s.splitting, "with " + path_of(scene_, s.order) +
                            " \"published\" particles move before the pressure is known; allowed: "
                            "viscosity_first");
    if (scene_.output.energy && s.order == MpsOrder::published)
      fail(scene_.output.energy,
           "the balance is kept with " + path_of(scene_, s.order) + " \"single_move\" only");
  }

  /// Stages follow on each other: what a stage undoes must have been done.
  void check_loading() const {
    constexpr double most_shortening = 0.95;  // or nothing is left between the plates
    double shortening = 0;
    bool loaded = false, open = false;
    for (const LoadingStage& stage : scene_.loading) {
      const bool compresses =
          stage.kind == LoadingKind::compress || stage.kind == LoadingKind::isotropic;
      if (compresses) shortening += stage.strain;
      if (shortening > most_shortening)
        fail(stage.strain, "the sample would be compressed by " + show_rounded(shortening) +
                               " of its height in all; allowed: up to " + show(most_shortening));
      if (stage.kind == LoadingKind::unload && !loaded)
        fail(stage.kind, "there is nothing to unload; compress the sample before");
      if (open && stage.kind != LoadingKind::penetrate && stage.kind != LoadingKind::hold)
        fail(stage.kind,
             "the top plate is away since the stage \"penetrate\"; allowed: penetrate, "
             "hold");
      check_stage(stage);
      loaded = loaded || compresses;
      open = open || stage.kind == LoadingKind::penetrate;
    }
  }

  void check_stage(const LoadingStage& stage) const {
    const GrainsSettings& settings = std::get<GrainsSettings>(scene_.numerics);
    const std::string kind = quote(name_of(stage.kind));
    if (stage.kind == LoadingKind::stretch && !settings.bonded_plates)
      fail(stage.kind,
           kind + " pulls at the plates; set " + path_of(scene_, settings.bonded_plates));
    const bool takes_stress = stage.kind != LoadingKind::stretch &&
                              stage.kind != LoadingKind::penetrate &&
                              stage.kind != LoadingKind::hold;
    if (stage.stress > 0 && !takes_stress) fail(stage.stress, kind + " takes no stress");
  }

  void check_terrain(const TerrainSpec& terrain) const {
    const bool from_map = !terrain.thickness_file.empty();
    for (const AreaSpec& area : terrain.release) {
      check_area(area);
      if (!from_map) check_thickness(area, terrain);
    }
    for (const AreaSpec& area : terrain.entrainment) {
      check_area(area);
      check_thickness(area, terrain);
    }
    for (const ResistanceSpec& area : terrain.resistance) check_area(area);
  }

  void check_thickness(const AreaSpec& area, const TerrainSpec& terrain) const {
    if (area.thickness > terrain.max_thickness)
      fail(area.thickness, show(area.thickness) + " m of snow; at most " +
                               show(terrain.max_thickness) +
                               " m are believed: is it in centimetres? Else raise " +
                               path_of(scene_, terrain.max_thickness));
  }

  template <class Area>
  void check_area(const Area& area) const {
    check_ring(area.outline);
    for (const HoleSpec& hole : area.holes) check_ring(hole.outline);
  }

  void check_ring(const Ring& ring) const {
    if (twice_signed_area(ring) == 0.0) fail(ring, "encloses no area");
    if (crosses_itself(ring)) fail(ring, "crosses or touches itself");
  }

  template <class T>
  void check_in_domain(const T& member, const ShapeSpec& shape) const {
    const auto bounds = shape_bounds(shape);
    if (!scene_.domain || !bounds) return;
    const double rounding = 1e-6 * resolution(scene_.numerics);
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
    constexpr int deepest = 16;  // well inside the JSON parser's limit and any stack
    if (depth > deepest)
      fail(shape, "shapes are nested more than " + std::to_string(deepest) + " deep");
    const bool has_axis = shape.type == "cylinder" || shape.type == "capsule";
    if (has_axis && shape.from == shape.to)
      fail(shape.to, "must differ from " + path_of(scene_, shape.from));
    if (shape.type == "plate" && Vec3::UnitY().cross(shape.normal).norm() == 0.0)
      fail(shape.normal, "a plate facing along y has no slope");
    for (const auto& part : shape.shapes) check_shape(part, depth + 1);
  }

  void check_seeding(const Seeding& seeding) const {
    const double given = seeding.particles_per_voxel;
    const double least = in_3d() ? 6.0 : 4.0;  // thesis A.3.2
    if (given != 0.0 && given < least && !seeding.allow_sparse)
      fail(seeding.particles_per_voxel, show(given) + " is too few in " + (in_3d() ? "3D" : "2D") +
                                            ": give at least " + show(least) +
                                            ", 0 for the default, or set " +
                                            path_of(scene_, seeding.allow_sparse));
  }

  void check_damping(const MpmSettings& settings) const {
    if (settings.damping_rate && settings.transfer != Transfer::flip)
      fail(settings.damping_rate, "the transfer \"" + std::string(name_of(settings.transfer)) +
                                      "\" has no PIC that damps; leave it out");
  }

  const Scene& scene_;
};

}  // namespace

void check_parts(const Scene& scene, const MethodInfo& method) {
  const auto check = [&](const auto& part, bool given, bool taken) {
    if (given && !taken)
      throw InputError(path_of(scene, part),
                       "the method " + quote(method.name) + " takes no such part");
  };
  check(scene.panel, scene.panel.has_value(), method.takes.panel);
  check(scene.slab, scene.slab.has_value(), method.takes.slab);
  check(scene.ground, scene.ground.has_value(), method.takes.ground);
  check(scene.obstacles, !scene.obstacles.empty(), method.takes.obstacles);
  check(scene.bodies, !scene.bodies.empty(), method.takes.bodies);
  check(scene.domain, scene.domain.has_value(), method.takes.domain);
  check(scene.terrain, scene.terrain.has_value(), method.takes.terrain);
  check(scene.sample, scene.sample.has_value(), method.takes.sample);
  check(scene.loading, !scene.loading.empty(), method.takes.sample);
  check(scene.cone, scene.cone.has_value(), method.takes.sample);
}

void check_rules(const Scene& scene) { SceneRules(scene).check(); }

}  // namespace snowshed
