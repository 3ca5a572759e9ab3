// Reading whole untrusted files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace snowshed::io {

/// Returns the content of a regular file of at most 1 GiB. Throws InputError for anything else: a
/// pipe or a device could block or never end.
std::string read_bytes(const std::filesystem::path& path);

/// Returns the size of the file. Throws InputError unless it is a regular file of at most 1 GiB.
std::uintmax_t check_readable(const std::filesystem::path& path);

/// Returns "path: byte n", a location for an InputError.
std::string at_byte(const std::filesystem::path& path, std::size_t offset);

}  // namespace snowshed::io
