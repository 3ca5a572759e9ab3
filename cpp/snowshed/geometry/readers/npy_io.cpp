#include "snowshed/geometry/readers/npy_io.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <regex>

#include "snowshed/core/memory.hpp"
#include "snowshed/geometry/readers/byte_reader.hpp"

namespace snowshed::geometry {
namespace {

constexpr std::size_t max_header = 1024;

struct ArrayHeader {
  std::string type;
  std::vector<std::size_t> shape;
  std::size_t data_offset;

  /// The digit in a type such as '<f4'.
  std::size_t value_size() const { return std::size_t(type[type.size() - 2] - '0'); }
  bool is_signed() const { return type[type.size() - 3] == 'i'; }
};

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t offset,
                       const std::string& what) {
  throw InputError(io::at_byte(path, offset), what);
}

/// Returns the text of the value of `key` in the header's dictionary.
std::string entry(const std::filesystem::path& path, const std::string& header,
                  const std::string& key, const std::string& pattern, const char* allowed) {
  std::smatch match;
  if (!std::regex_search(header, match, std::regex("'" + key + "' *: *(" + pattern + ") *[,}]")))
    fail(path, 10, "'" + key + "' of the array; allowed: " + allowed);
  return match[1];
}

std::vector<std::size_t> parse_shape(const std::string& tuple) {
  std::vector<std::size_t> shape;
  std::size_t at = 0;
  while ((at = tuple.find_first_of("0123456789", at)) != std::string::npos) {
    std::size_t used = 0;
    shape.push_back(std::stoull(tuple.substr(at), &used));
    at += used;
  }
  return shape;
}

/// Types and shapes that an array may have, as regular expressions and as text for messages.
struct AllowedArray {
  const char *type, *types, *shape, *shapes;
};

constexpr AllowedArray samples{"'<f[48]'", "'<f4' and '<f8'",
                               R"(\( *\d{1,9}( *, *\d{1,9}){1,2} *,? *\))", "two or three counts"};
constexpr AllowedArray labels{
    "'(\\||<)[iu]1'|'<[iu][248]'", "integers of 1 to 8 bytes, little-endian",
    R"(\( *\d{1,9}( *, *\d{1,9}){2} *,? *\))", "three counts (nz, ny, nx)"};

ArrayHeader parse_header(const std::filesystem::path& path, const std::string& bytes,
                         const AllowedArray& allowed) {
  if (bytes.compare(0, 6, "\x93NUMPY", 6) != 0) fail(path, 0, "not a .npy file");
  ByteReader reader(path, bytes, 6, ByteOrder::little);
  const int major = reader.read<std::uint8_t>();
  reader.skip(1);
  if (major < 1 || major > 3)
    fail(path, 6, "format version " + std::to_string(major) + "; allowed: 1 to 3");
  const std::size_t length =
      major == 1 ? reader.read<std::uint16_t>() : reader.read<std::uint32_t>();
  if (length > max_header || length > reader.remaining())
    fail(path, 8,
         "a header of " + std::to_string(length) + " bytes; at most 1024, within the file");
  const std::size_t begin = bytes.size() - reader.remaining();
  const std::string text = bytes.substr(begin, length);
  ArrayHeader header;
  header.type = entry(path, text, "descr", allowed.type, allowed.types);
  entry(path, text, "fortran_order", "False", "False (C order)");
  header.shape = parse_shape(entry(path, text, "shape", allowed.shape, allowed.shapes));
  header.data_offset = begin + length;
  return header;
}

/// Returns the number of values. They must fill the rest of the file.
std::size_t checked_count(const std::filesystem::path& path, const ArrayHeader& header,
                          std::size_t bytes_left) {
  const std::size_t value_size = header.value_size();
  double count = 1;
  for (const std::size_t n : header.shape) count *= static_cast<double>(n);
  if (count * value_size != static_cast<double>(bytes_left))
    fail(path, header.data_offset,
         "the shape asks for " + std::to_string(count * value_size) +
             " bytes of values; there are " + std::to_string(bytes_left));
  return bytes_left / value_size;
}

/// Reads the next integer; an integer beyond 63 bits, which is not allowed, becomes negative.
std::int64_t next_integer(ByteReader& reader, const ArrayHeader& header) {
  const auto read = [&](auto with_sign, auto without) -> std::int64_t {
    if (header.is_signed()) return reader.read<decltype(with_sign)>();
    return std::int64_t(reader.read<decltype(without)>());
  };
  switch (header.value_size()) {
    case 1:
      return read(std::int8_t(), std::uint8_t());
    case 2:
      return read(std::int16_t(), std::uint16_t());
    case 4:
      return read(std::int32_t(), std::uint32_t());
    default:
      return read(std::int64_t(), std::uint64_t());
  }
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
  const std::string bytes = io::read_bytes(path);
  const ArrayHeader header = parse_header(path, bytes, samples);
  const std::size_t count = checked_count(path, header, bytes.size() - header.data_offset);
  ByteReader reader(path, bytes, header.data_offset, ByteOrder::little);
  NpyArray array{header.shape, std::vector<float>(count)};
  for (float& value : array.values) {
    value =
        header.type == "'<f4'" ? reader.read<float>() : static_cast<float>(reader.read<double>());
    if (!std::isfinite(value)) reader.fail("the value before this byte is not finite");
  }
  return array;
}

namespace {

/// Throws InputError if a file has more labels than a sample may have. Reads only the header: a
/// sparse file can claim a lot of memory without using disk space. Samples of 512^3 voxels are
/// already too large for a loading test.
void check_label_count(const std::filesystem::path& path) {
  constexpr std::uintmax_t max_bytes = std::uintmax_t(640) << 20;
  constexpr double max_labels = 512.0 * 512.0 * 512.0;
  const std::uintmax_t size = io::check_readable(path);
  if (size > max_bytes)
    throw InputError(path.string(),
                     std::to_string(size) + " bytes; at most 640 MiB of labels are read");
  std::string head(std::size_t(std::min<std::uintmax_t>(size, 2 * max_header)), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), std::streamsize(head.size()));
  double count = 1;
  for (const std::size_t n : parse_header(path, head, labels).shape) count *= double(n);
  if (count > max_labels && count <= double(size))
    throw InputError(path.string(),
                     "more than 512^3 labels; crop the image, or give larger voxels");
}

}  // namespace

NpyLabels read_npy_labels(const std::filesystem::path& path) {
  check_label_count(path);
  const std::string bytes = io::read_bytes(path);
  const ArrayHeader header = parse_header(path, bytes, labels);
  const std::size_t count = checked_count(path, header, bytes.size() - header.data_offset);
  if (count * sizeof(std::int32_t) > available_memory_bytes())
    fail(path, header.data_offset, std::to_string(count) + " labels do not fit into memory");
  ByteReader reader(path, bytes, header.data_offset, ByteOrder::little);
  NpyLabels array{header.shape, std::vector<std::int32_t>(count)};
  for (std::int32_t& label : array.values) {
    const std::int64_t value = next_integer(reader, header);
    if (value < 0 || value > std::numeric_limits<std::int32_t>::max())
      reader.fail("the label before this byte is negative or above 2147483647");
    label = std::int32_t(value);
  }
  return array;
}

}  // namespace snowshed::geometry
