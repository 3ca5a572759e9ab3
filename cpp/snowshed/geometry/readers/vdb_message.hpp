// The output of the program snowshed-vdb when it reads a grid. The program is built together with
// the library that starts it, so the two can exchange structs as they are in memory.
#pragma once

#include <cstdint>

namespace snowshed::geometry {

/// The largest number of voxels in the box around a grid's active voxels.
inline constexpr std::uint64_t max_vdb_samples = 50'000'000;

enum class VdbKind : std::uint32_t { level_set, fog_volume };

/// Precedes the samples, which are floats with z running fastest. Lengths are in the file's unit.
struct VdbHeader {
  static constexpr std::uint64_t expected_mark = 0x31626476'776f6e73;  // "snowvdb1"

  std::uint64_t mark = expected_mark;
  std::uint64_t counts[3] = {};
  double origin[3] = {};
  double spacing = 0;
  double background = 0;  // level sets: width of the narrow band
  VdbKind kind = VdbKind::level_set;
  std::uint32_t padding = 0;
};

}  // namespace snowshed::geometry
