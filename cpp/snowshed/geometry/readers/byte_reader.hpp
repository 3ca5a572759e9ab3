// Reading numbers from the bytes of an untrusted file.
#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed::geometry {

enum class ByteOrder { little, big };

/// Reads numbers one after another. Throws InputError with the file and the byte.
class ByteReader {
 public:
  ByteReader(const std::filesystem::path& path, std::string_view bytes, std::size_t offset,
             ByteOrder order)
      : path_(path), bytes_(bytes), offset_(offset), order_(order) {}

  std::size_t remaining() const { return bytes_.size() - offset_; }

  template <class Number>
  Number read() {
    if (remaining() < sizeof(Number)) fail("the file ends in the middle of a number");
    unsigned char raw[sizeof(Number)];
    std::memcpy(raw, bytes_.data() + offset_, sizeof(Number));
    if (order_ != native_order()) std::reverse(raw, raw + sizeof(Number));
    offset_ += sizeof(Number);
    Number number;
    std::memcpy(&number, raw, sizeof(Number));
    return number;
  }

  void skip(std::size_t count) {
    if (remaining() < count) fail("the file ends too early");
    offset_ += count;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(io::at_byte(path_, offset_), what);
  }

 private:
  static ByteOrder native_order() {
    const unsigned short one = 1;
    unsigned char first;
    std::memcpy(&first, &one, 1);
    return first == 1 ? ByteOrder::little : ByteOrder::big;
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t offset_;
  ByteOrder order_;
};

}  // namespace snowshed::geometry
