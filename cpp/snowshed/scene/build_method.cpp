#include "snowshed/scene/build_method.hpp"

#include "snowshed/methods/grains/solver.hpp"
#include "snowshed/methods/mpm/solver.hpp"
#include "snowshed/methods/mps/solver.hpp"
#include "snowshed/methods/slide/solver.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/build_sample.hpp"
#include "snowshed/scene/build_terrain.hpp"
#include "snowshed/scene/file_notes.hpp"
#include "snowshed/scene/resolve_obstacles.hpp"

namespace snowshed {
namespace {

std::unique_ptr<Method> build(const MpmSettings& settings, const Scene& scene,
                              const std::vector<Snow>& snows, const Surroundings& surroundings) {
  MpmOptions o;
  o.dimension = scene.dimension;
  o.gravity = scene.gravity;
  o.snows = snows;
  o.numerics = settings;
  o.energy = scene.output.energy;
  return make_mpm(o, surroundings.resolved);
}

std::unique_ptr<Method> build(const SlideSettings& settings, const Scene& scene,
                              const std::vector<Snow>&, const Surroundings& surroundings) {
  return make_slide(
      {settings, scene.gravity, surroundings.terrain, surroundings.areas, scene.output.energy});
}

std::unique_ptr<Method> build(const GrainsSettings& settings, const Scene& scene,
                              const std::vector<Snow>&, const Surroundings& surroundings) {
  return make_grains({settings, scene.gravity, surroundings.sample, scene.loading,
                      scene.cone.value_or(Cone{}), scene.output.energy});
}

std::unique_ptr<Method> build(const MpsSettings& settings, const Scene& scene,
                              const std::vector<Snow>&, const Surroundings& surroundings) {
  MpsOptions o;
  o.dimension = scene.dimension;
  o.settings = settings;
  o.gravity = -scene.gravity * Vec3::UnitZ();
  o.obstacles = surroundings.resolved;
  o.energy = scene.output.energy;
  return make_mps(std::move(o));
}

}  // namespace

Surroundings build_surroundings(const Scene& scene, const std::filesystem::path& base_dir) {
  Surroundings s;
  s.obstacles = build_obstacles(scene, base_dir, &s.notes);
  s.resolved = resolve_obstacles(scene, s.obstacles, s.notes);
  add_notes_on_files(scene, base_dir, s.obstacles, s.notes);
  if (scene.terrain && scene.uses<SlideSettings>()) {
    s.terrain =
        build_height_field(*scene.terrain, std::get<SlideSettings>(scene.numerics), base_dir);
    s.areas = build_areas(*scene.terrain, s.terrain, base_dir);
  }
  if (scene.sample) s.sample = build_sample(*scene.sample, base_dir);
  return s;
}

std::unique_ptr<Method> build_method(const Scene& scene, const std::vector<Snow>& snows,
                                     const Surroundings& surroundings) {
  return std::visit(
      [&](const auto& settings) { return build(settings, scene, snows, surroundings); },
      scene.numerics);
}

}  // namespace snowshed
