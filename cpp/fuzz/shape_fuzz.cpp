// A file as a solid: refused, or one with finite distances and unit normals. The solid's type and
// the extension of the file are compiled in, so that each format has a target of its own.
#include <cmath>

#include "fuzzing.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/scene/build_shape.hpp"

namespace snowshed {
namespace {

void look_around(const LevelSet& shape) {
  const Bounds bounds = shape.bounds();
  require(shape.inradius() >= 0 && std::isfinite(shape.inradius()), "inradius");
  for (const double part : {-0.5, 0.0, 0.25, 0.5, 1.0}) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
      const bool bounded = std::isfinite(bounds.max[axis] - bounds.min[axis]);
      x[axis] = bounded ? bounds.min[axis] + part * (bounds.max[axis] - bounds.min[axis]) : part;
    }
    require(std::isfinite(shape.distance(x)), "a distance is not finite");
    require(std::abs(shape.normal(x).norm() - 1) < 1e-6, "a normal has no unit length");
  }
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, SNOWSHED_FUZZ_EXTENSION);
  ShapeSpec spec;
  spec.type = SNOWSHED_FUZZ_TYPE;
  spec.file = file.path().string();
  spec.spacing = 0.1;  // of grids
  for (const int dimension : {2, 3})
    allow_refusal([&] { look_around(*build_shape(spec, dimension, "/shape", "")); });
  return 0;
}
