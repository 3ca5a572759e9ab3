// Helpers shared by the mutators, which change the content of a file and keep its frame valid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace snowshed {

/// Largest number of bytes by which a part grows in a mutation.
constexpr std::size_t max_part_growth = 64;

template <class T>
T number_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <class T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Returns the bytes after a mutation by libFuzzer.
inline std::string mutate(std::string bytes, std::size_t max_size) {
  const std::size_t size = bytes.size();
  bytes.resize(std::max(size, max_size));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, max_size));
  return bytes;
}

/// Does the work of LLVMFuzzerCustomMutator on its arguments: replaces the data by `mutated(bytes,
/// random)`, unless that is too long.
template <class Mutated>
std::size_t replace_data(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                         Mutated mutated) {
  std::mt19937 random(seed);
  const std::string bytes = mutated(std::string(reinterpret_cast<const char*>(data), size), random);
  if (bytes.size() > max_size) return size;
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

}  // namespace snowshed
