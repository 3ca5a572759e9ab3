// Files of terrain and meshes.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "array_copies.hpp"
#include "bindings.hpp"
#include "snowshed/geometry/readers/ascii_grid.hpp"
#include "snowshed/geometry/readers/mesh_io.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

py::tuple ascii_grid(const std::filesystem::path& path) {
  geometry::GridAssumptions assumptions;
  const geometry::HeightField f = geometry::read_ascii_grid(path, &assumptions);
  return py::make_tuple(map_of(f.heights, f.rows, f.columns), f.west, f.south, f.cell,
                        assumptions.undeclared_missing, assumptions.decimal_commas);
}

py::tuple mesh_arrays(const std::filesystem::path& path, double scale) {
  const geometry::TriangleMesh mesh = geometry::read_mesh(path, scale);
  py::array_t<std::int64_t> triangles({py::ssize_t(mesh.triangles.size()), py::ssize_t(3)});
  auto out = triangles.mutable_unchecked<2>();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) out(py::ssize_t(t), py::ssize_t(k)) = mesh.triangles[t][k];
  return py::make_tuple(rows(mesh.vertices), triangles);
}

}  // namespace

void bind_geometry(py::module_& m) {
  using namespace py::literals;
  m.def("read_ascii_grid", &ascii_grid, "path"_a,
        "(heights, west, south, cell, number of undeclared -9999 values, number of decimal commas) "
        "of an ESRI ASCII grid, the southernmost row first.");
  m.def("read_mesh", &mesh_arrays, "path"_a, "scale"_a = 1.0,
        "Vertices (n, 3), m, and triangles (m, 3) of an STL, OBJ or PLY file.");
}

}  // namespace snowshed
