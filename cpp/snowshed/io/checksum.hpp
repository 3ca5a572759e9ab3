// Checksums that find damage of files. They are no protection against manipulation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace snowshed::io {

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

/// The checksum CRC-32 of ISO 3309, as zlib computes it: for files that other programs read, too.
class Crc32 {
 public:
  void update(const void* data, std::size_t bytes) {
    const auto* next = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i)
      state_ = table()[(state_ ^ next[i]) & 0xffu] ^ (state_ >> 8);
  }

  std::uint32_t value() const { return ~state_; }

 private:
  using Table = std::array<std::uint32_t, 256>;

  static const Table& table() {
    static const Table made = [] {
      Table t{};
      for (std::uint32_t n = 0; n < t.size(); ++n) {
        t[n] = n;
        for (int bit = 0; bit < 8; ++bit) t[n] = (t[n] & 1u ? 0xedb88320u : 0u) ^ (t[n] >> 1);
      }
      return t;
    }();
    return made;
  }

  std::uint32_t state_ = 0xffffffffu;
};

/// A checksum as eight hexadecimal digits.
inline std::string hexadecimal(std::uint32_t sum) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", sum);
  return text;
}

}  // namespace snowshed::io
