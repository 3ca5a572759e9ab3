// What the program snowshed-vdb answers when it is asked for a grid. It is built together with
// whoever asks, so that structs can travel as they are.
#pragma once

#include <cstdint>

namespace snowshed {

/// Larger boxes around what a grid holds are refused.
inline constexpr std::uint64_t max_vdb_samples = 50'000'000;

enum class VdbKind : std::uint32_t { level_set, fog_volume };

/// Stands before the samples, which are floats with z running fastest; lengths in the file's unit.
struct VdbHeader {
  static constexpr std::uint64_t expected_mark = 0x31626476'776f6e73;  // "snowvdb1"

  std::uint64_t mark = expected_mark;
  std::uint64_t counts[3] = {};
  double origin[3] = {};
  double spacing = 0;
  double background = 0;  // of a level set: the width of its band
  VdbKind kind = VdbKind::level_set;
  std::uint32_t padding = 0;
};

}  // namespace snowshed
