// .npy files shared by tests.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace snowshed::geometry_testing {

/// Returns the bytes of a .npy file with the given header dictionary.
inline std::string npy_file(int major, std::string dictionary, const std::string& data) {
  dictionary += "  \n";
  std::string out = "\x93NUMPY";
  out += static_cast<char>(major);
  out += '\0';
  const auto length = static_cast<std::uint32_t>(dictionary.size());
  for (int byte = 0; byte < (major == 1 ? 2 : 4); ++byte)
    out += static_cast<char>(length >> 8 * byte & 0xff);
  return out + dictionary + data;
}

template <class Number>
std::string npy_data(const std::vector<Number>& values) {
  std::string raw(values.size() * sizeof(Number), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return raw;
}

inline std::string npy_header(const std::string& type, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
}

}  // namespace snowshed::geometry_testing
