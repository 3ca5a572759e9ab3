// Archives that were changed on purpose: their checksums fit.
#pragma once

#include <cstring>
#include <string>

#include "snowshed/io/checksum.hpp"

namespace snowshed {

inline std::string with_valid_sum(std::string bytes) {
  Checksum sum;
  sum.update(bytes.data(), bytes.size() - 8);
  const std::uint64_t value = sum.value();
  std::memcpy(&bytes[bytes.size() - 8], &value, 8);
  return bytes;
}

/// `bytes` with a number replaced.
template <class T>
std::string forged(std::string bytes, std::size_t offset, T value) {
  std::memcpy(&bytes[offset], &value, sizeof value);
  return with_valid_sum(std::move(bytes));
}

/// Where the data of the section of that name begin, if the name is shorter than eight characters.
inline std::size_t data_of(const std::string& bytes, std::string name) {
  name.resize(8);
  return bytes.find(name) + 8;
}

}  // namespace snowshed
