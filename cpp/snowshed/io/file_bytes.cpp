#include "snowshed/io/file_bytes.hpp"

#include <fstream>
#include <system_error>

#include "snowshed/core/errors.hpp"

namespace snowshed::io {

std::uintmax_t check_readable(const std::filesystem::path& path) {
  constexpr std::uintmax_t max_bytes = std::uintmax_t(1) << 30;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string(), "no such file");
  if (!std::filesystem::is_regular_file(status))
    throw InputError(path.string(), "not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string(), "cannot be read: " + error.message());
  if (size > max_bytes)
    throw InputError(path.string(), std::to_string(size) + " bytes; at most 1 GiB is read");
  return size;
}

std::string read_bytes(const std::filesystem::path& path) {
  const std::uintmax_t size = check_readable(path);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file || !file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(path.string(), "cannot be read");
  return bytes;
}

std::string at_byte(const std::filesystem::path& path, std::size_t offset) {
  return path.string() + ": byte " + std::to_string(offset);
}

}  // namespace snowshed::io
