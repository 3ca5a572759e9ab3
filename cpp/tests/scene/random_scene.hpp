// Valid scenes with every field at random.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/scene/describe.hpp"

namespace snowshed::scene {

/// Visitor that gives every field a value its range allows.
class Randomizer {
 public:
  Randomizer(std::mt19937_64& random, int dimension, int depth = 0)
      : random_(random), dimension_(dimension), depth_(depth) {}

  void version(const char*, int, const char*) {}
  void number(const char*, double& value, const char*, const methods::Range& range, const char*) {
    value = draw(range);
  }
  void number_instead(const char*, std::optional<double>& value, const char*, const char*,
                      const methods::Range& range, const char*) {
    if (chance(0.5)) value = draw(range);
  }
  void integer(const char*, int& value, const methods::Range& range, const char*) {
    value = std::uniform_int_distribution<int>(int(range.min), int(range.max))(random_);
  }
  void integer(const char*, std::uint64_t& value, const methods::Range&, const char*) {
    value = random_();
  }
  void flag(const char*, bool& value, const char*) { value = chance(0.5); }
  void text(const char*, std::string& value, const char*) {
    value = "Name \"\\\n\t\x01 \xc3\xa9 \xf0\x9f\x8f\x94 / ~ " + std::to_string(random_());
  }
  void file(const char*, std::string& value, const char*) { value = "meshes/roof of 1.stl"; }
  void choice(const char*, const methods::Choice& value, const char*) {
    value.choose(random_() % value.names().size());
  }
  void vector(const char*, Vec3& value, const char*, const methods::Range& range, const char*) {
    value = {draw(range), dimension_ == 3 ? draw(range) : 0.0, draw(range)};
  }
  void direction(const char*, Vec3& value, const char*) {
    vector("", value, "", methods::between(0.1, 1.0), "");
  }
  void axis(const char*, Vec3& value, const char* doc) {
    if (dimension_ == 3) direction("", value, doc);
  }
  void spin(const char*, Vec3& value, const char*, const methods::Range& range, const char*) {
    value = {0.0, draw(range), 0.0};
    if (dimension_ == 3) vector("", value, "", range, "");
  }
  template <class T>
  void object(const char*, T& value, methods::Need, const char*) {
    fill(value);
  }
  template <class T>
  void optional(const char*, std::optional<T>& value, const char*) {
    if (chance(0.7)) fill(value.emplace());
  }
  template <class T>
  void list(const char*, std::vector<T>& items, const methods::Range& count, const char*) {
    items.resize(std::size_t(std::min(count.max, count.min + double(random_() % 3))));
    for (auto& item : items) fill(item);
  }
  void variants(const char*, std::string& type, const char*) {
    static const std::vector<const char*> solid = {"box",   "sphere", "cylinder", "capsule",
                                                   "plate", "mesh",   "grid",     "vdb"};
    static const std::vector<const char*> nested = {"union", "difference", "transform"};
    const auto& kinds = depth_ < 4 && chance(0.3) ? nested : solid;
    type_ = type = kinds[random_() % kinds.size()];
  }
  bool variant(const char* name, const char*) { return type_ == name; }
  void end_variants() {}
  void method(const char*, const char*, methods::MethodChoice& settings, const char*, const char*) {
    fill(settings);
  }
  void read_method_first(const char*, methods::MethodChoice& settings) {
    if (chance(0.2)) settings = methods::mps::Settings();
    if (dimension_ != 3) return;
    if (chance(0.3)) settings = methods::slide::Settings();
    if (chance(0.2)) settings = methods::grains::Settings();
  }
  bool shows(const char*, const methods::MethodChoice& settings, methods::Part part) {
    return settings.takes(part);
  }
  void only_for_methods_with(methods::Part) {}
  void outline(const char*, geometry::Ring& ring, const char*) {
    const double x = draw(methods::between(0, 1e3)), y = draw(methods::between(0, 1e3));
    ring = {{x, y}, {x + 30, y}, {x + 30, y + 20.5}, {x, y + 20}};
  }
  void alias(const char*, const char*) {}
  void accuracy(std::initializer_list<const char*>) {}

 private:
  template <class T>
  void fill(T& value) {
    Randomizer deeper(random_, dimension_, depth_ + 1);
    describe(deeper, value);
  }
  bool chance(double p) { return std::uniform_real_distribution<>()(random_) < p; }
  double draw(const methods::Range& range) {
    const double low = std::max(range.min, -1e3), high = std::min(range.max, low + 1e4);
    double value = std::uniform_real_distribution<>(low, high)(random_);
    if (chance(0.1) && range.contains(1.0 / 3.0)) value = 1.0 / 3.0;
    if (chance(0.1) && range.contains(1e-308)) value = 1e-308;
    if (chance(0.1) && range.contains(low)) value = low;
    return range.contains(value) ? value : 0.5 * (low + high);
  }

  std::mt19937_64& random_;
  int dimension_, depth_;
  std::string type_;
};

/// Turns a scene into a slide, which has terrain and only the parts that its method takes.
inline void mend_slide(Randomizer& randomizer, Scene& scene) {
  scene.panel.reset();
  scene.slab.reset();
  scene.ground.reset();
  scene.obstacles.clear();
  scene.bodies.clear();
  scene.snow = {};
  scene.seeding = {};
  if (!scene.terrain) describe(randomizer, scene.terrain.emplace());
  scene.terrain->max_thickness = 100;  // as thick as an area may be
  scene.events.count = 1;
  scene.output.energy = scene.output.forces = false;
  methods::slide::Settings& settings = scene.numerics.as<methods::slide::Settings>();
  settings.explicit_friction = false;
  const methods::slide::Settings usual;
  if (scene.terrain->resistance.empty() || !(settings.detrainment > 0))
    settings.ground_gains_detrained = false;
  if (scene.terrain->entrainment.empty()) settings.ground_loses_entrained = false;
  if (settings.mode == methods::slide::Mode::compatible) {
    scene.terrain->thickness_file.clear();
    settings.columns = usual.columns;
    settings.mixing_rate = usual.mixing_rate;
    settings.ground_rest_time = usual.ground_rest_time;
    if (!scene.terrain->secondary_release.empty() || !scene.terrain->inflows.empty())
      settings.ground_gains_stopped = settings.ground_gains_detrained =
          settings.ground_loses_entrained = false;
    for (methods::InflowSpec& inflow : scene.terrain->inflows) inflow.bonds = false;
    scene.terrain->dams.resize(std::min<std::size_t>(1, scene.terrain->dams.size()));
    for (methods::DamSpec& dam : scene.terrain->dams) dam.restitution = std::round(dam.restitution);
  } else {
    settings.artificial_viscosity = usual.artificial_viscosity;
    for (methods::DamSpec& dam : scene.terrain->dams) dam.slope = 90;
  }
}

/// Turns a scene into a loading test of a sample, in stages that may follow each other.
inline void mend_grains(Randomizer& randomizer, Scene& scene) {
  scene.panel.reset();
  scene.slab.reset();
  scene.ground.reset();
  scene.terrain.reset();
  scene.obstacles.clear();
  scene.bodies.clear();
  scene.snow = {};
  scene.seeding = {};
  if (!scene.sample) describe(randomizer, scene.sample.emplace());
  scene.events.count = 1;
  scene.output.forces = false;
  scene.numerics.as<methods::grains::Settings>().bonded_plates = true;
  scene.loading.insert(scene.loading.begin(), methods::LoadingStage{});
  for (methods::LoadingStage& stage : scene.loading) {
    stage.strain = std::min(stage.strain, 0.1);
    if (stage.kind == methods::LoadingKind::penetrate) stage.kind = methods::LoadingKind::shear;
    if (stage.kind == methods::LoadingKind::stretch || stage.kind == methods::LoadingKind::hold)
      stage.stress = 0;
  }
  if (scene.cone) scene.loading.push_back({methods::LoadingKind::penetrate, 0.5, 0.2, 0});
}

/// Turns a scene into an MPS scene, whose snow is part of the method's settings.
inline void mend_mps(Scene& scene) {
  scene.snow = {};
  scene.seeding = {};
  scene.events.between = methods::Between::carry;
  for (auto& body : scene.bodies) {
    body.snow.reset();
    body.volume = 0;
  }
  if (scene.slab)
    for (auto& layer : scene.slab->layers) layer.snow.reset();
  methods::mps::Settings& settings = scene.numerics.as<methods::mps::Settings>();
  settings.erosion = false;
  settings.order = methods::mps::Order::single_move;
}

/// Returns a scene with random fields, which are then changed to obey the rules between fields.
inline Scene random_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Scene scene;
  const int dimension = seed % 2 ? 3 : 2;
  Randomizer randomizer(random, dimension);
  describe(randomizer, scene);
  scene.dimension = dimension;
  scene.domain.reset();
  scene.seeding.allow_sparse = true;
  scene.events.rest_time = std::min(scene.events.rest_time, scene.events.max_time);
  if (!scene.numerics.is<methods::grains::Settings>()) {
    scene.sample.reset();
    scene.cone.reset();
  }
  if (scene.numerics.is<methods::slide::Settings>()) {
    mend_slide(randomizer, scene);
    return scene;
  }
  if (scene.numerics.is<methods::grains::Settings>()) {
    mend_grains(randomizer, scene);
    return scene;
  }
  scene.terrain.reset();
  if (!scene.panel) scene.slab.reset();
  if (scene.panel && scene.ground) scene.ground->tilt = std::min(scene.ground->tilt, 0.0);
  if (scene.slab) {
    scene.slab->length = std::min(scene.slab->length, scene.panel->length);
    scene.slab->width = std::min(scene.slab->width, scene.panel->width);
    for (auto& layer : scene.slab->layers) layer.event = std::min(layer.event, scene.events.count);
    if (!scene.slab->layers.empty())
      scene.slab->thickness = 0.0;
    else if (scene.slab->thickness == 0.0)
      scene.slab->thickness = 0.1;
  }
  if (!scene.slab) describe(randomizer, scene.bodies.emplace_back());
  if (scene.numerics.is<methods::mps::Settings>()) {
    mend_mps(scene);
  } else {
    methods::mpm::Settings& numerics = scene.numerics.as<methods::mpm::Settings>();
    numerics.scheme = methods::mpm::Scheme::thesis;
    if (numerics.device == methods::mpm::DeviceSetting::gpu)  // machines of tests have none
      numerics.device = methods::mpm::DeviceSetting::automatic;
    if (numerics.transfer == methods::mpm::Transfer::apic) numerics.damping_rate.reset();
    if (numerics.transfer != methods::mpm::Transfer::affine_flip || !numerics.damping_rate)
      numerics.damping_length = 0;
    if (numerics.crack_band_length > 0) numerics.crack_band_length = 2 * numerics.dx;
    if (numerics.damping_rate) numerics.flip_ratio = methods::mpm::Settings{}.flip_ratio;
  }
  for (auto& body : scene.bodies) body.event = std::min(body.event, scene.events.count);
  for (auto& obstacle : scene.obstacles)
    if (obstacle.motion)
      obstacle.motion->end = std::max(obstacle.motion->start, obstacle.motion->end);
  return scene;
}

}  // namespace snowshed::scene
