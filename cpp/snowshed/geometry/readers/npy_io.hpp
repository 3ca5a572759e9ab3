// Reading NumPy's .npy files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace snowshed::geometry {

/// An array in C order; the last index runs fastest.
struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

/// Reads a .npy file of format version 1, 2 or 3 that holds a two- or three-dimensional array of
/// little-endian f4 or f8 values in C order. The file is untrusted. Every fault gives an InputError
/// that names the file, the byte and what is allowed.
NpyArray read_npy(const std::filesystem::path& path);

/// A three-dimensional array of labels in C order.
struct NpyLabels {
  std::vector<std::size_t> shape;
  std::vector<std::int32_t> values;
};

/// Reads such a file of labels: little-endian integers of one to eight bytes, none of them negative
/// or above 2^31 - 1. Memory is checked before it is allocated.
NpyLabels read_npy_labels(const std::filesystem::path& path);

}  // namespace snowshed::geometry
