// Errors a user can act on: what was wrong, where, what is allowed.
#pragma once

#include <stdexcept>
#include <string>

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

/// The simulation itself cannot go on (non-finite state, time step underflow).
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reading or writing a file failed.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace snowshed
