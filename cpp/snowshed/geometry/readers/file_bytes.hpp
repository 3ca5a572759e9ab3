// Reading whole files that are not to be trusted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace snowshed {

/// The content of a regular file of at most 1 GiB; InputError otherwise (pipes and devices
/// could block or never end).
std::string read_bytes(const std::filesystem::path& path);

/// InputError unless `path` is a regular file of at most 1 GiB; its size.
std::uintmax_t check_readable(const std::filesystem::path& path);

/// "path: byte n", the place in an InputError.
std::string at_byte(const std::filesystem::path& path, std::size_t offset);

}  // namespace snowshed
