#include "snowshed/io/folder_lock.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

using FolderLockTest = TemporaryFolder;

TEST_F(FolderLockTest, HasOneHolderAtATime) {
  std::filesystem::create_directories(path("a"));
  FolderLock first(path("a"));
  EXPECT_EQ(message_of<InputError>([&] { FolderLock(path("a")); }),
            path("a").string() + ": in use: another run writes into this folder");
  FolderLock moved(std::move(first));
  EXPECT_THROW(FolderLock(path("a")), InputError);
  moved.release();
  EXPECT_NO_THROW(FolderLock(path("a")));
}

TEST_F(FolderLockTest, NamesAMissingFolder) {
  EXPECT_EQ(message_of<FileError>([&] { FolderLock(path("missing")); }),
            path("missing").string() + ": No such file or directory");
}

}  // namespace
}  // namespace snowshed::io
