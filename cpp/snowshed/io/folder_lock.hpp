// A lock on a folder: one program at a time writes into it.
#pragma once

#include <filesystem>

namespace snowshed::io {

/// Locks a folder during its lifetime; the system also releases the lock when the process dies.
/// Throws InputError if another process holds the lock. On a file system without locks it does
/// nothing.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&&) noexcept;
  FolderLock& operator=(FolderLock&&) noexcept;

  /// Releases the folder to other processes.
  void release();

 private:
  int descriptor_;
};

}  // namespace snowshed::io
