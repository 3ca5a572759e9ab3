#include "snowshed/geometry/mesh_solid.hpp"

#include <utility>

#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"
#include "snowshed/geometry/mesh_section.hpp"
#include "snowshed/geometry/readers/mesh_io.hpp"

namespace snowshed::geometry {

Shape make_mesh_solid(const std::filesystem::path& file, double scale, int dimension,
                      std::vector<std::string>* notes) {
  ShellSolid solid = read_solid(file, scale);
  if (notes)
    for (const std::string& note : solid.notes) notes->push_back(file.string() + ": " + note);
  if (dimension == 2) solid.layers = sections_at_y0(solid.layers, file.string());
  std::vector<Shape> shapes;
  for (TriangleMesh& layer : solid.layers) shapes.push_back(make_mesh(std::move(layer)));
  return shapes.size() == 1 ? shapes.front() : unite(std::move(shapes));
}

}  // namespace snowshed::geometry
