// Fuzz target of labels of grains. A file must be refused, or give a label for each voxel.
#include "fuzzing.hpp"
#include "snowshed/geometry/readers/npy_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".npy");
  allow_refusal([&] {
    const geometry::NpyLabels labels = geometry::read_npy_labels(file.path());
    std::size_t voxels = 1;
    for (const std::size_t side : labels.shape) voxels *= side;
    require(labels.shape.size() == 3 && labels.values.size() == voxels, "voxels");
    for (const std::int32_t label : labels.values) require(label >= 0, "a label is negative");
  });
  return 0;
}
