#include "snowshed/core/child_process.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "snowshed/core/errors.hpp"

extern char** environ;

namespace snowshed {
namespace {

[[noreturn]] void fail(const std::filesystem::path& program, int error) {
  throw FileError(program.string(), std::string("cannot be run: ") + std::strerror(error), error);
}

/// A pipe whose ends are closed when they are no longer needed.
class Pipe {
 public:
  explicit Pipe(const std::filesystem::path& program) {
    if (::pipe(ends_) != 0) fail(program, errno);
    for (const int end : ends_) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  }
  ~Pipe() {
    ::close(ends_[0]);
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

  /// Returns the bytes that are written until the other end is closed.
  std::string drain() {
    std::string all;
    char buffer[1 << 16];
    while (true) {
      const ssize_t count = ::read(ends_[0], buffer, sizeof buffer);
      if (count > 0) all.append(buffer, std::size_t(count));
      if (count == 0 || (count < 0 && errno != EINTR)) return all;
    }
  }

 private:
  int ends_[2] = {-1, -1};
};

::pid_t start(const std::filesystem::path& program, std::vector<std::string> arguments,
              const Pipe& pipe) {
  arguments.insert(arguments.begin(), program.string());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(program, error);
  return child;
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments) {
  Pipe pipe(program);
  const ::pid_t child = start(program, arguments, pipe);
  pipe.close_writing();
  ChildResult result;
  result.output = pipe.drain();
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail(program, errno);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

std::optional<std::filesystem::path> find_sibling_program(const std::string& name) {
  std::vector<std::filesystem::path> folders;
  ::Dl_info info;
  if (::dladdr(reinterpret_cast<const void*>(&run_child), &info) && info.dli_fname)
    folders.push_back(std::filesystem::path(info.dli_fname).parent_path());
  // For an executable found on the path, dladdr gives only the name by which it was called.
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(self.parent_path());
  for (const auto& folder : folders) {
    const auto file = folder / name;
    if (std::filesystem::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0)
      return std::filesystem::absolute(file);
  }
  return std::nullopt;
}

}  // namespace snowshed
