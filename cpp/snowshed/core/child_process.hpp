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

/// A program in the folder of the library or executable that this code is part of.
std::optional<std::filesystem::path> beside_this_binary(const std::string& name);

}  // namespace snowshed
