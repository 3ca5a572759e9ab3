#include "snowshed/scene/file_notes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "snowshed/core/message_format.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/build_shape.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed::scene {
namespace {

/// Files in millimetres that are read as metres, or the reverse, are 1000 times too large or small.
constexpr double max_size_ratio = 300;

struct Solid {
  std::string file;  // empty: of no file
  double size;       // m, its longest edge; infinite or 0 if it has none
};

/// The first file that a shape is made of.
std::string file_of(const ShapeSpec& shape) {
  if (!shape.file.empty()) return shape.file;
  for (const ShapeSpec& part : shape.shapes)
    if (const std::string file = file_of(part); !file.empty()) return file;
  return "";
}

double longest_edge(const geometry::Bounds& bounds, int dimension) {
  Vec3 size = bounds.max - bounds.min;
  if (dimension == 2) size.y() = 0;
  return size.maxCoeff();
}

double size_of_body(const BodySpec& body, std::size_t i, const Scene& scene,
                    const std::filesystem::path& base_dir, std::vector<std::string>& notes) {
  if (!file_of(body.shape).empty())
    return longest_edge(build_shape(body.shape, scene.dimension,
                                    "/bodies/" + std::to_string(i) + "/shape", base_dir, &notes)
                            ->bounds(),
                        scene.dimension);
  const auto box = shape_bounds(body.shape);
  return box ? longest_edge({box->min(), box->max()}, scene.dimension) : geometry::infinity;
}

std::vector<Solid> solids_of(const Scene& scene, const std::filesystem::path& base_dir,
                             const std::vector<methods::Obstacle>& obstacles,
                             std::vector<std::string>& notes) {
  std::vector<Solid> solids;
  if (scene.panel) solids.push_back({"", scene.panel->length});
  const std::vector<methods::Obstacle> listed = listed_obstacles(scene, obstacles);
  for (std::size_t i = 0; i < listed.size(); ++i)
    solids.push_back({file_of(scene.obstacles[i].shape),
                      longest_edge(listed[i].shape->bounds(), scene.dimension)});
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    solids.push_back(
        {file_of(scene.bodies[i].shape), size_of_body(scene.bodies[i], i, scene, base_dir, notes)});
  return solids;
}

}  // namespace

void add_notes_on_files(const Scene& scene, const std::filesystem::path& base_dir,
                        const std::vector<methods::Obstacle>& obstacles,
                        std::vector<std::string>& notes) {
  const std::vector<Solid> solids = solids_of(scene, base_dir, obstacles, notes);
  const double cell = scene.numerics->resolution();
  for (const Solid& solid : solids) {
    if (solid.file.empty() || !std::isfinite(solid.size)) continue;
    const std::string size =
        solid.file + ": the solid is " + show_briefly(solid.size) + " m" + " large, ";
    const std::string question = "; if the file is in another unit, set its \"scale\"";
    double largest = 0;  // the largest value of all others
    for (const Solid& other : solids)
      if (&other != &solid && std::isfinite(other.size)) largest = std::max(largest, other.size);
    if (solid.size < cell)
      notes.push_back(size + "less than a cell of " + show_briefly(cell) + " m" + question);
    else if (largest > 0 && solid.size > max_size_ratio * largest)
      notes.push_back(size + "and everything else at most " + show_briefly(largest) + " m" +
                      question);
    else if (largest > max_size_ratio * solid.size)
      notes.push_back(size + "and others up to " + show_briefly(largest) + " m" + question);
  }
}

}  // namespace snowshed::scene
