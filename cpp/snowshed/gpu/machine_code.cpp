#include "snowshed/gpu/machine_code.hpp"

#include <cstdio>
#include <exception>
#include <optional>

#include "snowshed/gpu/cache_folder.hpp"
#include "snowshed/gpu/embedded_sources.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/checksum.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/io/fingerprint.hpp"

namespace snowshed::gpu {
namespace {

constexpr std::size_t checksum_digits = 8;

/// Adds a text with its end, so that no two lists of texts look the same.
void add(io::Fingerprint& print, const std::string& text) {
  print.add(text.c_str(), text.size() + 1);
}

/// The name of a file that holds the code: all that decides it.
std::string file_name(const RuntimeCompiler& compiler, const KernelProgram& program,
                      int architecture) {
  io::Fingerprint print;
  add(print, program.name);
  add(print, program.source);
  for (const std::string& option : program.options) add(print, option);
  for (const SourceText& source : embedded_sources()) {
    add(print, source.name);
    add(print, source.text);
  }
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(print.value()));
  return std::string(digits) + "-sm" + std::to_string(architecture) + "-nvrtc" +
         compiler.version() + ".cubin";
}

std::string checksum_of(const std::string& code) {
  io::Crc32 sum;
  sum.update(code.data(), code.size());
  return io::hexadecimal(sum.value());
}

/// The code in a file; none if the file is missing or damaged.
std::optional<std::string> read_code(const std::filesystem::path& file) try {
  if (!std::filesystem::is_regular_file(file)) return std::nullopt;
  const std::string bytes = io::read_bytes(file);
  if (bytes.size() <= checksum_digits) return std::nullopt;
  std::string code = bytes.substr(checksum_digits);
  if (bytes.compare(0, checksum_digits, checksum_of(code)) != 0) return std::nullopt;
  return code;
} catch (const std::exception&) {
  return std::nullopt;
}

/// Keeps the code; a folder that cannot be written costs the next process a compilation only.
void write_code(const std::filesystem::path& file, const std::string& code) try {
  std::filesystem::create_directories(file.parent_path());
  io::write_atomic(file, checksum_of(code) + code);
} catch (const std::exception&) {
  return;
}

}  // namespace

std::filesystem::path machine_code_folder() {
  const std::filesystem::path cache = cache_folder();
  return cache.empty() ? cache : cache / "kernels";
}

std::string machine_code(const RuntimeCompiler& compiler, const KernelProgram& program,
                         int architecture) {
  const std::filesystem::path folder = machine_code_folder();
  if (folder.empty()) return compiler.compile(program, architecture);
  const std::filesystem::path file = folder / file_name(compiler, program, architecture);
  if (auto code = read_code(file)) return *code;
  std::string code = compiler.compile(program, architecture);
  write_code(file, code);
  return code;
}

}  // namespace snowshed::gpu
