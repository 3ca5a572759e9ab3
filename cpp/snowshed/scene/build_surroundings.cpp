#include "snowshed/scene/build_surroundings.hpp"

#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/distinct_snows.hpp"
#include "snowshed/scene/effect_notes.hpp"
#include "snowshed/scene/file_notes.hpp"
#include "snowshed/scene/thicken_obstacles.hpp"
#include "snowshed/scene/unusual_values.hpp"

namespace snowshed::scene {

methods::Surroundings build_surroundings(const Scene& scene,
                                         const std::filesystem::path& base_dir) {
  methods::Surroundings s;
  add_notes_on_unusual_values(scene, s.notes);
  s.snows = distinct_snows(scene);
  s.obstacles = build_obstacles(scene, base_dir, &s.notes);
  s.resolved = thicken_obstacles(scene, s.obstacles, s.notes);
  add_notes_on_files(scene, base_dir, s.obstacles, s.notes);
  add_notes_on_effects(scene, s.obstacles, s.notes);
  s.input = scene.numerics->read(view_of(scene), base_dir);
  return s;
}

}  // namespace snowshed::scene
