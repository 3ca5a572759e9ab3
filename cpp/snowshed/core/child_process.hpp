// Running another program to its end.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snowshed {

struct ChildResult {
  int exit_code = 0;
  int signal = 0;      // signal that ended it; 0 if none did
  std::string output;  // its standard output
};

/// Runs a program and waits for it; its standard error is dropped. Throws FileError if it cannot be
/// started.
ChildResult run_child(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments);

/// Returns the path of the program `name` in the folder of the library or executable that contains
/// this code; none if the folder has no such program.
std::optional<std::filesystem::path> find_sibling_program(const std::string& name);

}  // namespace snowshed
