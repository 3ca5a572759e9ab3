// Files that grow: bytes are appended all or not at all. Errors are FileError with the path.
#pragma once

#include <cstddef>
#include <filesystem>

namespace snowshed {

/// Appends bytes to an existing file. Where that fails, the file is as long as before; if the
/// process is killed meanwhile, it may hold a part of them.
void append_to_file(const std::filesystem::path& path, const void* data, std::size_t bytes);

/// Cuts a file to a length.
void truncate_file(const std::filesystem::path& path, std::size_t bytes);

}  // namespace snowshed
