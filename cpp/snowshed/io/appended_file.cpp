#include "snowshed/io/appended_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

constexpr std::size_t max_append = std::size_t{1} << 30;  // Linux transfers no more than 2 GiB

class FileDescriptor {
 public:
  explicit FileDescriptor(const std::filesystem::path& path) {
    do {
      number_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    } while (number_ < 0 && errno == EINTR);
  }
  ~FileDescriptor() {
    if (number_ >= 0) ::close(number_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

[[noreturn]] void fail_at(const std::filesystem::path& path, const char* action, int error) {
  throw FileError(path.string(),
                  std::string(action) + ": " + std::generic_category().message(error), error);
}

}  // namespace

void append_to_file(const std::filesystem::path& path, const void* data, std::size_t bytes) {
  const FileDescriptor file(path);
  struct stat status;
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0)
    fail_at(path, "cannot open the file", errno);
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(file.number(), next, std::min(bytes, max_append));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      if (::ftruncate(file.number(), status.st_size) != 0) {
        // Readers detect the incomplete bytes that remain.
      }
      fail_at(path, "cannot write the file", error);
    }
    next += written;
    bytes -= std::size_t(written);
  }
}

void truncate_file(const std::filesystem::path& path, std::size_t bytes) {
  std::error_code error;
  std::filesystem::resize_file(path, bytes, error);
  if (error) fail_at(path, "cannot cut the file", error.value());
}

}  // namespace snowshed::io
