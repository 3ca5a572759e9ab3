// Fuzz target of shapes from files. A file must be refused, or give a solid with finite distances
// and unit normals. The type of the shape and the extension of the file are compiled in, so that
// each format has its own target.
#include <cmath>

#include "fuzzing.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/scene/build_shape.hpp"

namespace snowshed {
namespace {

void check_samples(const geometry::LevelSet& shape) {
  const geometry::Bounds bounds = shape.bounds();
  require(shape.inradius() >= 0 && std::isfinite(shape.inradius()), "inradius");
  for (const double fraction : {-0.5, 0.0, 0.25, 0.5, 1.0}) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
      const bool bounded = std::isfinite(bounds.max[axis] - bounds.min[axis]);
      x[axis] =
          bounded ? bounds.min[axis] + fraction * (bounds.max[axis] - bounds.min[axis]) : fraction;
    }
    require(std::isfinite(shape.distance(x)), "a distance is not finite");
    require(std::abs(shape.normal(x).norm() - 1) < 1e-6, "a normal is not of unit length");
  }
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, SNOWSHED_FUZZ_EXTENSION);
  scene::ShapeSpec spec;
  spec.type = SNOWSHED_FUZZ_TYPE;
  spec.file = file.path().string();
  spec.spacing = 0.1;  // for grids
  for (const int dimension : {2, 3})
    allow_refusal([&] { check_samples(*scene::build_shape(spec, dimension, "/shape", "")); });
  return 0;
}
