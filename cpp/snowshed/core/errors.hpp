// Errors that a user can act on: the fault, its place, and the allowed values.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <utility>

namespace snowshed {

/// Bad input: scene, mesh, grid file, option. `where` is a JSON path
/// ("/snow/density"), a file, or "file:line". Programs exit with code 2 on it.
class InputError : public std::runtime_error {
 public:
  InputError(std::string where, const std::string& what)
      : std::runtime_error(where.empty() ? what : where + ": " + what), where_(std::move(where)) {}
  const std::string& where() const { return where_; }

 private:
  std::string where_;
};

/// The simulation itself cannot continue (non-finite state, time step underflow).
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A failure to read or write a file: the file, the action, and the system's error number (errno; 0
/// if it gives none).
class FileError : public std::runtime_error {
 public:
  FileError(std::string file, const std::string& what, int code)
      : std::runtime_error(file + ": " + what), file_(std::move(file)), code_(code) {}
  const std::string& file() const { return file_; }
  int code() const { return code_; }

  /// Returns whether the cause is a full or broken disk rather than the request.
  bool is_of_disk() const {
    return code_ == ENOSPC || code_ == EDQUOT || code_ == EIO || code_ == EFBIG;
  }

 private:
  std::string file_;
  int code_;
};

}  // namespace snowshed
