// The search for NVIDIA's runtime compiler.
#include <cstdlib>
#include <mutex>
#include <system_error>

#include "snowshed/gpu/runtime_compiler.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

constexpr const char* file_names[] = {"libnvrtc.so.13", "libnvrtc.so.12"};  // the newest first
constexpr const char* remedy = "pip install \"snowshed[gpu]\"";

/// The program that embeds this library knows where its packages lie; nothing else is kept here.
struct FolderSource {
  std::mutex mutex;
  std::function<Folders()> folders;
};

FolderSource& folder_source() {
  static FolderSource source;
  return source;
}

Folders compiler_folders() {
  FolderSource& source = folder_source();
  const std::lock_guard lock(source.mutex);
  return source.folders ? source.folders() : Folders();
}

std::vector<std::string> candidates() {
  std::vector<std::string> libraries;
  std::error_code error;
  for (const auto& folder : compiler_folders())
    for (const char* file : file_names)
      if (std::filesystem::exists(folder / file, error))
        libraries.push_back((folder / file).string());
  libraries.insert(libraries.end(), std::begin(file_names), std::end(file_names));
  return libraries;
}

[[noreturn]] void refuse_newer(const std::string& version, int max_major) {
  throw Unavailable("NVIDIA's runtime compiler " + version +
                    " makes code that this driver cannot load, which supports CUDA " +
                    std::to_string(max_major) + "; update the driver" +
                    (max_major < 12 ? "" : ", or: pip install nvidia-cuda-nvrtc-cu12"));
}

RuntimeCompiler open_named(const std::string& library, int max_major) try {
  RuntimeCompiler compiler(library);
  if (compiler.major() > max_major) refuse_newer(compiler.version(), max_major);
  return compiler;
} catch (const Unavailable& error) {
  throw Unavailable("SNOWSHED_NVRTC: " + std::string(error.what()));
}

}  // namespace

void set_compiler_folders(std::function<Folders()> folders) {
  FolderSource& source = folder_source();
  const std::lock_guard lock(source.mutex);
  source.folders = std::move(folders);
}

RuntimeCompiler open_compiler(int max_major) {
  if (const char* chosen = std::getenv("SNOWSHED_NVRTC"); chosen && *chosen)
    return open_named(chosen, max_major);
  std::string newer, reason;
  for (const std::string& library : candidates()) try {
      RuntimeCompiler compiler(library);
      if (compiler.major() <= max_major) return compiler;
      if (newer.empty()) newer = compiler.version();
    } catch (const Unavailable& error) {
      if (reason.empty()) reason = error.what();
    }
  if (!newer.empty()) refuse_newer(newer, max_major);
  throw Unavailable("NVIDIA's runtime compiler is not installed: " + reason + "; " + remedy);
}

}  // namespace snowshed::gpu
