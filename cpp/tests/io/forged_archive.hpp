// Manipulated archives with a valid checksum.
#pragma once

#include <cstring>
#include <string>

#include "snowshed/io/checksum.hpp"

namespace snowshed::io {

/// Returns `bytes` with a valid checksum.
inline std::string with_valid_sum(std::string bytes) {
  Checksum sum;
  sum.update(bytes.data(), bytes.size() - 8);
  const std::uint64_t value = sum.value();
  std::memcpy(&bytes[bytes.size() - 8], &value, 8);
  return bytes;
}

/// Returns `bytes` with a number replaced and a valid checksum.
template <class T>
std::string forged(std::string bytes, std::size_t offset, T value) {
  std::memcpy(&bytes[offset], &value, sizeof value);
  return with_valid_sum(std::move(bytes));
}

/// Returns the offset of a section's data. The name must be shorter than eight characters.
inline std::size_t data_of(const std::string& bytes, std::string name) {
  name.resize(8);
  return bytes.find(name) + 8;
}

}  // namespace snowshed::io
