// A lock on a folder: one program at a time writes into it.
#pragma once

#include <filesystem>

namespace snowshed {

/// Holds a folder for as long as it lives; the system releases it too when the process dies. Throws
/// InputError if another holds the folder. A file system without locks is not locked.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&&) noexcept;
  FolderLock& operator=(FolderLock&&) noexcept;

  /// Lets another hold the folder.
  void release();

 private:
  int descriptor_;
};

}  // namespace snowshed
