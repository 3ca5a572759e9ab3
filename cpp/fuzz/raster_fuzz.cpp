// Fuzz target of ESRI ASCII grids. A file must be refused, or give a height for each node, which is
// finite or missing.
#include <cmath>

#include "fuzzing.hpp"
#include "snowshed/geometry/readers/ascii_grid.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".asc");
  allow_refusal([&] {
    const geometry::HeightField field = geometry::read_ascii_grid(file.path());
    require(field.columns >= 2 && field.rows >= 2 && field.cell > 0, "size");
    require(std::isfinite(field.west) && std::isfinite(field.south), "position");
    require(field.heights.size() == std::size_t(field.columns) * std::size_t(field.rows), "nodes");
    for (const double height : field.heights)
      require(std::isnan(height) || std::abs(height) <= 1e5, "a height is beyond 1e5 m");
  });
  return 0;
}
