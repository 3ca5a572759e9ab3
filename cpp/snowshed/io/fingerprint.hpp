// Numbers that show whether a file is still the same.
#pragma once

#include <cstddef>
#include <cstdint>

namespace snowshed::io {

/// A hash (FNV-1a, 64 bits): different bytes give different numbers, barring rare collisions.
class Fingerprint {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i)
      value_ = (value_ ^ bytes[i]) * 1099511628211ull;
  }
  std::int64_t value() const { return std::int64_t(value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace snowshed::io
