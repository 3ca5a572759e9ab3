// Atomic files: written under a temporary name, flushed, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace snowshed::io {

/// A file that appears at `path` complete or not at all. Bytes go to a temporary file in the same
/// folder; `commit` renames it to `path`. Without a commit, or after an error, the temporary is
/// removed and an older file at `path` stays as it was. All errors are FileError with the path and
/// the reason.
///
/// A device or a pipe cannot be replaced by renaming; it is written directly. A link stays; the
/// file that it names is replaced.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Makes the file durable and visible. Nothing may be written afterwards. `check`, where given,
  /// is called with the path of the temporary; if it throws, the older file stays.
  void commit(const std::function<void(const std::filesystem::path&)>& check = {});

 private:
  void flush();
  void write_through(const char* data, std::size_t bytes);
  void sync();
  void discard() noexcept;
  [[noreturn]] void fail(const char* action);

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty if `path_` is written directly
  int descriptor_ = -1;
  std::vector<char> buffer_;
};

/// Returns whether a folder's entry is the temporary file of a process that was killed, or of one
/// that is still writing.
bool is_leftover(const std::filesystem::directory_entry&);

/// Removes temporary files from a folder; the caller must hold the lock of the folder. Files that
/// cannot be removed stay.
void remove_leftovers(const std::filesystem::path& folder);

/// Writes the whole content of a file atomically.
void write_atomic(const std::filesystem::path& path, std::string_view content);

}  // namespace snowshed::io
