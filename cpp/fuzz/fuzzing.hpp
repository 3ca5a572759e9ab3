// Helpers shared by the fuzz targets. A target is a function LLVMFuzzerTestOneInput. libFuzzer
// calls it with mutated bytes, replay_main.cpp with the bytes of given files.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "snowshed/core/errors.hpp"

namespace snowshed {

/// A temporary file with the given bytes, for readers that take only files.
class InputFile {
 public:
  InputFile(const std::uint8_t* data, std::size_t size, const std::string& extension)
      : path_(std::filesystem::temp_directory_path() /
              ("snowshed-fuzz-" + std::to_string(::getpid()) + extension)) {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  ~InputFile() { std::filesystem::remove(path_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs `read`, which may refuse its input with a located InputError. Any other exception leaves
/// this function and ends the program, which libFuzzer reports.
template <class Read>
void allow_refusal(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    if (error.where().empty()) throw std::logic_error("an InputError without a location");
  }
}

/// Ends the program unless `condition` holds, which it must for every input that was not refused.
inline void require(bool condition, const char* what) {
  if (!condition) throw std::logic_error(what);
}

}  // namespace snowshed
