// Files that grow. An append writes all bytes or none. Errors are FileError with the path.
#pragma once

#include <cstddef>
#include <filesystem>

namespace snowshed::io {

/// Appends bytes to an existing file. If that fails, the file keeps its former length. If the
/// process is killed meanwhile, the file may end with a part of the bytes.
void append_to_file(const std::filesystem::path& path, const void* data, std::size_t bytes);

/// Cuts a file to a length.
void truncate_file(const std::filesystem::path& path, std::size_t bytes);

}  // namespace snowshed::io
