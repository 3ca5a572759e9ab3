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
/// A panel in centimetres is 100 times too long beside its snow.
constexpr double max_panel_ratio = 100;
/// Thinner slabs on a panel are noted.
constexpr double min_slab_ratio = 1.0 / 400;
/// Lowest and highest lower edge, and least and largest width, beside the length of a panel.
constexpr double min_height_ratio = 1.0 / 60, max_height_ratio = 30;
constexpr double min_width_ratio = 1.0 / 30, max_width_ratio = 100;

struct Solid {
  std::string path;
  std::string file;  // empty: of no file
  double size;       // m, its longest edge; infinite or 0 if it has none
  bool is_snow = false;
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
  if (scene.panel) solids.push_back({"/panel/length", "", scene.panel->length});
  const std::vector<methods::Obstacle> listed = listed_obstacles(scene, obstacles);
  for (std::size_t i = 0; i < listed.size(); ++i)
    solids.push_back({"/obstacles/" + std::to_string(i) + "/shape",
                      file_of(scene.obstacles[i].shape),
                      longest_edge(listed[i].shape->bounds(), scene.dimension)});
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    solids.push_back({"/bodies/" + std::to_string(i) + "/shape", file_of(scene.bodies[i].shape),
                      size_of_body(scene.bodies[i], i, scene, base_dir, notes), true});
  return solids;
}

/// A note if the length of the panel and another size are not of the same unit.
void compare(const std::string& path, double size, const char* adjective, double panel,
             double least, double most, std::vector<std::string>& notes) {
  if (size <= 0 || !std::isfinite(size) || (least * panel <= size && size <= most * panel)) return;
  notes.push_back(path + ": " + show_briefly(size) + " m " + adjective + " beside a panel of " +
                  show_briefly(panel) + " m; check the units of both");
}

void add_notes_on_panel(const Scene& scene, const std::vector<Solid>& solids,
                        std::vector<std::string>& notes) {
  if (!scene.panel) return;
  const double panel = scene.panel->length;
  compare("/panel/height", scene.panel->height, "high", panel, min_height_ratio, max_height_ratio,
          notes);
  if (scene.dimension == 3)
    compare("/panel/width", scene.panel->width, "wide", panel, min_width_ratio, max_width_ratio,
            notes);
  if (scene.slab) {
    double thickness = scene.slab->thickness;
    for (const Layer& layer : scene.slab->layers) thickness = std::max(thickness, layer.thickness);
    compare("/slab", thickness, "thick", panel, min_slab_ratio, 1, notes);
    compare("/slab/length", scene.slab->length, "long", panel, 1 / max_panel_ratio, 1, notes);
  }
  for (const Solid& solid : solids)
    if (solid.is_snow && solid.file.empty())
      compare(solid.path, solid.size, "large", panel, 1 / max_panel_ratio, max_panel_ratio, notes);
}

}  // namespace

void add_notes_on_files(const Scene& scene, const std::filesystem::path& base_dir,
                        const std::vector<methods::Obstacle>& obstacles,
                        std::vector<std::string>& notes) {
  const std::vector<Solid> solids = solids_of(scene, base_dir, obstacles, notes);
  const double cell = scene.numerics->resolution();
  add_notes_on_panel(scene, solids, notes);
  for (const Solid& solid : solids) {
    if (!std::isfinite(solid.size)) continue;
    const bool is_read = !solid.file.empty();
    const std::string size = (is_read ? solid.file : solid.path) + ": the solid is " +
                             show_briefly(solid.size) + " m" + " large, ";
    const std::string question =
        is_read ? "; if the file is in another unit, set its \"scale\"" : "; check its unit";
    double largest = 0;  // the largest value of all others
    for (const Solid& other : solids)
      if (&other != &solid && std::isfinite(other.size) && (is_read || other.file.empty()))
        largest = std::max(largest, other.size);
    if (is_read && solid.size < cell)
      notes.push_back(size + "less than a cell of " + show_briefly(cell) + " m" + question);
    else if (largest > 0 && solid.size > max_size_ratio * largest)
      notes.push_back(size + "and everything else at most " + show_briefly(largest) + " m" +
                      question);
    else if (is_read && largest > max_size_ratio * solid.size)
      notes.push_back(size + "and others up to " + show_briefly(largest) + " m" + question);
  }
}

}  // namespace snowshed::scene
