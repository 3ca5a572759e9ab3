#include "snowshed/scene/build_obstacles.hpp"

#include "snowshed/geometry/primitives.hpp"
#include "snowshed/scene/build_shape.hpp"
#include "snowshed/scene/obstacle_specs.hpp"

namespace snowshed::scene {
namespace {

/// The ground and the panel come before the obstacles of the scene's list.
std::size_t standing_before_listed(const Scene& scene) {
  return std::size_t(scene.ground.has_value()) + std::size_t(scene.panel.has_value());
}

/// The sides of the domain: six (in 2D four) half-spaces that snow sticks to.
void add_domain_walls(const Scene& scene, std::vector<methods::Obstacle>& obstacles) {
  if (!scene.domain) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && scene.dimension == 2) continue;
    const Vec3 inward = Vec3::Unit(axis);
    const methods::ContactLaw sticky{methods::Condition::sticky, 0.0};
    obstacles.push_back(
        {"domain", geometry::make_plane(scene.domain->min, inward), sticky, std::nullopt});
    obstacles.push_back(
        {"domain", geometry::make_plane(scene.domain->max, -inward), sticky, std::nullopt});
  }
}

}  // namespace

std::vector<methods::Obstacle> build_obstacles(const Scene& scene,
                                               const std::filesystem::path& base_dir,
                                               std::vector<std::string>* notes) {
  std::vector<methods::Obstacle> obstacles;
  const std::size_t first = standing_before_listed(scene);
  for (const ObstacleSpec& spec : obstacle_specs(scene)) {
    const std::size_t i = obstacles.size();
    const std::string path =
        i < first ? "/" + spec.name : "/obstacles/" + std::to_string(i - first) + "/shape";
    methods::Obstacle o{spec.name,
                        build_shape(spec.shape, scene.dimension, path, base_dir, notes),
                        {spec.condition, spec.friction},
                        std::nullopt};
    if (spec.motion) o.motion.emplace(*spec.motion);
    obstacles.push_back(std::move(o));
  }
  add_domain_walls(scene, obstacles);
  return obstacles;
}

std::vector<methods::Obstacle> listed_obstacles(const Scene& scene,
                                                const std::vector<methods::Obstacle>& built) {
  const auto first = built.begin() + std::ptrdiff_t(standing_before_listed(scene));
  return {first, first + std::ptrdiff_t(scene.obstacles.size())};
}

}  // namespace snowshed::scene
