// A fast 64-bit checksum that finds damage of files. It is no protection against manipulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace snowshed {

/// A checksum of 64-bit words. Each step is a bijection of the state for a given word, and of the
/// word for a given state. Damage within one word is therefore always found.
class Checksum {
 public:
  /// Adds data; `bytes` must be a multiple of eight.
  void update(const void* data, std::size_t bytes) {
    const char* begin = static_cast<const char*>(data);
    for (std::size_t i = 0; i < bytes; i += sizeof(std::uint64_t)) {
      std::uint64_t word;
      std::memcpy(&word, begin + i, sizeof word);
      state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
      state_ ^= state_ >> 32;
    }
  }

  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace snowshed
