#include "snowshed/io/atomic_file.hpp"

#include <sys/resource.h>

#include <csignal>
#include <string>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

using AtomicFileTest = TemporaryFolder;

/// Within its scope no file can grow beyond `bytes`, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limit{bytes, previous_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_handler_);
  }

 private:
  rlimit previous_;
  void (*previous_handler_)(int);
};

TEST_F(AtomicFileTest, AppearsOnlyOnCommit) {
  AtomicFile file(path("a"));
  file.write("first ");
  file.write("second");
  EXPECT_FALSE(std::filesystem::exists(path("a")));
  file.commit();
  EXPECT_EQ(content(path("a")), "first second");
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(AtomicFileTest, KeepsTheOrderOfSmallAndLargePieces) {
  const std::string large(200'000, 'x');
  AtomicFile file(path("a"));
  for (const std::string& piece : {std::string("begin"), large, std::string("end")})
    file.write(piece);
  file.commit();
  EXPECT_EQ(content(path("a")), "begin" + large + "end");
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  {
    AtomicFile(path("a")).write("lost");
  }
  EXPECT_EQ(number_of_files(), 0u);
}

TEST_F(AtomicFileTest, ReplacesTheWholeOlderFile) {
  write_atomic(path("a"), "a long older content");
  write_atomic(path("a"), "new");
  EXPECT_EQ(content(path("a")), "new");
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(AtomicFileTest, KeepsTheOlderFileWhenTheDiskFillsUp) {
  write_atomic(path("a"), "older");
  std::string message;
  {
    const FileSizeLimit limit(100'000);
    message = message_of<FileError>([&] { write_atomic(path("a"), std::string(300'000, 'x')); });
  }
  EXPECT_NE(message.find(path("a").string() + ": cannot write: "), std::string::npos) << message;
  EXPECT_EQ(content(path("a")), "older");
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(AtomicFileTest, KeepsTheOlderFileWhenTheNewOneFailsItsCheck) {
  write_atomic(path("a"), "older");
  {
    AtomicFile file(path("a"));
    file.write("new");
    EXPECT_THROW(file.commit([](const std::filesystem::path& written) {
      throw InputError(written.string(), content(written));
    }),
                 InputError);
  }
  EXPECT_EQ(content(path("a")), "older");
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(AtomicFileTest, NamesPathAndReasonOfAMissingFolder) {
  const auto file = path("missing") / "a";
  EXPECT_EQ(message_of<FileError>([&] { write_atomic(file, "x"); }),
            file.string() + ": cannot create the file: No such file or directory");
}

TEST_F(AtomicFileTest, DoesNotReplaceAFolder) {
  std::filesystem::create_directories(path("folder"));
  EXPECT_THROW(write_atomic(path("folder"), "x"), FileError);
  EXPECT_TRUE(std::filesystem::is_directory(path("folder")));
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(AtomicFileTest, ALinkStaysAndItsTargetIsReplaced) {
  std::filesystem::create_directories(path("elsewhere"));
  write_atomic(path("elsewhere") / "a", "older");
  std::filesystem::create_symlink("elsewhere/a", path("link"));
  write_atomic(path("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(content(path("elsewhere") / "a"), "new");
}

TEST_F(AtomicFileTest, RemovesOnlyLeftoversOfKilledProcesses) {
  const char* leftover = ".partial-0123456789abcdef-a";
  for (const char* name :
       {leftover, ".partial-0123456789abcdef", ".partial-mine", "a.partial", "a"})
    write_atomic(path(name), "x");
  std::filesystem::create_symlink("a", path(".partial-fedcba9876543210-a"));
  remove_leftovers(path("."));
  EXPECT_FALSE(std::filesystem::exists(path(leftover)));
  EXPECT_EQ(number_of_files(), 5u);
  EXPECT_NO_THROW(remove_leftovers(path("missing")));
}

TEST_F(AtomicFileTest, WritesDevicesDirectly) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  EXPECT_EQ(message_of<FileError>([] { write_atomic("/dev/full", "x"); }),
            "/dev/full: cannot write: No space left on device");
  EXPECT_NO_THROW(write_atomic("/dev/null", "x"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace
}  // namespace snowshed::io
