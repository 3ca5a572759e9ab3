// A segmented image of snow: the grain that each voxel belongs to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace snowshed::methods::grains {

/// Voxel (i, j, k) has its centre at ((i, j, k) + 1/2) voxel_size and the label
/// labels[(k ny + j) nx + i]: x runs fastest, z is up. 0 is air, any other number is a grain.
struct LabelImage {
  std::array<std::size_t, 3> size{};  // nx, ny, nz
  double voxel_size = 0;              // m
  std::vector<std::int32_t> labels;

  std::int32_t at(std::size_t i, std::size_t j, std::size_t k) const {
    return labels[(k * size[1] + j) * size[0] + i];
  }
};

}  // namespace snowshed::methods::grains
