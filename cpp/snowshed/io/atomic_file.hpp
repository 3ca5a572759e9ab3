// Files that appear complete or not at all: written beside, flushed, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace snowshed {

/// A file under construction. Bytes go to a temporary in the same folder; `commit` puts it in
/// place of `path`. Destroyed without a commit, or after an error, it leaves nothing behind and
/// an older file at `path` as it was. All errors are FileError with the path and the reason.
///
/// Where `path` is a device or a pipe there is nothing to rename: it is written directly.
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
  std::filesystem::path temporary_;  // empty: `path_` is written directly
  int descriptor_ = -1;
  std::vector<char> buffer_;
};

/// The whole content at once.
void write_atomic(const std::filesystem::path& path, std::string_view content);

}  // namespace snowshed
