#include "snowshed/io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>

#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 16;
// Linux transfers no more than 2 GiB per call; smaller pieces are as fast.
constexpr std::size_t max_write = std::size_t{1} << 30;

std::string reason(int error) { return std::generic_category().message(error); }

constexpr std::string_view temporary_prefix = ".partial-";
constexpr std::size_t temporary_digits = 16;

/// Returns a random name in the same folder: a link planted under a name that can be guessed would
/// redirect the file.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
  std::random_device random;
  const std::uint64_t number = std::uint64_t{random()} << 32 | random();
  char digits[temporary_digits + 1];
  std::snprintf(digits, sizeof digits, "%016" PRIx64, number);
  std::string name(temporary_prefix);
  const std::string own = path.filename().string();  // its end, so that more fits into a name
  constexpr std::size_t max_length = 100;
  return path.parent_path() /
         (name + digits + "-" + own.substr(own.size() - std::min(own.size(), max_length)));
}

bool is_device_or_pipe(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::is_other(status);
}

/// Returns where a link leads, so that the link stays and the file that it names is replaced.
std::filesystem::path target_of(std::filesystem::path path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path;
  auto target = std::filesystem::weakly_canonical(path, failed);
  return failed ? path : target;
}

int retry_open(const std::filesystem::path& path, int flags) {
  int descriptor;
  do {
    descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

/// Flushes the folder of `path`. Without this a power cut may undo the rename. Some file systems
/// refuse to flush a folder. This is no error, because the file itself is already safe.
void sync_folder(const std::filesystem::path& path) {
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const int descriptor = retry_open(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(target_of(std::move(path))) {
  int flags = O_WRONLY;
  if (!is_device_or_pipe(path_)) {
    temporary_ = temporary_name(path_);
    flags |= O_CREAT | O_EXCL;
  }
  descriptor_ = retry_open(temporary_.empty() ? path_ : temporary_, flags);
  if (descriptor_ < 0) {
    temporary_.clear();  // this object did not create it and must not remove it
    fail("cannot create the file");
  }
  buffer_.reserve(buffer_bytes);
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* begin = static_cast<const char*>(data);
  if (buffer_.size() + bytes > buffer_bytes) flush();
  if (bytes > buffer_bytes)
    write_through(begin, bytes);
  else
    buffer_.insert(buffer_.end(), begin, begin + bytes);
}

void AtomicFile::commit(const std::function<void(const std::filesystem::path&)>& check) {
  flush();
  sync();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot close the file");
  if (temporary_.empty()) return;
  if (check) check(temporary_);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot put the file in place");
  temporary_.clear();
  sync_folder(path_);
}

void AtomicFile::flush() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::write_through(const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, data, bytes < max_write ? bytes : max_write);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write");
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::sync() {
  // Devices, pipes and some network folders cannot be flushed.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS)
    fail("cannot write");
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(const char* action) {
  const int error = errno;  // `discard` may overwrite it
  discard();
  throw FileError(path_.string(), std::string(action) + ": " + reason(error), error);
}

bool is_leftover(const std::filesystem::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  const std::size_t end = temporary_prefix.size() + temporary_digits;
  std::error_code ignored;
  return entry.symlink_status(ignored).type() == std::filesystem::file_type::regular &&
         name.compare(0, temporary_prefix.size(), temporary_prefix) == 0 &&
         name.find_first_not_of("0123456789abcdef", temporary_prefix.size()) == end &&
         name[end] == '-';
}

void remove_leftovers(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> leftovers;
  for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed))
    if (is_leftover(*at)) leftovers.push_back(at->path());
  for (const auto& path : leftovers) std::filesystem::remove(path, failed);
}

void write_atomic(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace snowshed::io
