#include "snowshed/scene/build_surroundings.hpp"

#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/file_notes.hpp"
#include "snowshed/scene/resolve_obstacles.hpp"

namespace snowshed {

Surroundings build_surroundings(const Scene& scene, const std::filesystem::path& base_dir) {
  Surroundings s;
  s.snows = assemble_snows(scene);
  s.obstacles = build_obstacles(scene, base_dir, &s.notes);
  s.resolved = resolve_obstacles(scene, s.obstacles, s.notes);
  add_notes_on_files(scene, base_dir, s.obstacles, s.notes);
  s.input = scene.numerics->read(view_of(scene), base_dir);
  return s;
}

}  // namespace snowshed
