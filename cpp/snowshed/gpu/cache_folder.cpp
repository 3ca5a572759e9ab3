#include "snowshed/gpu/cache_folder.hpp"

#include <cstdlib>

namespace snowshed::gpu {
namespace {

std::filesystem::path folder_in(const char* variable) {
  const char* value = std::getenv(variable);
  std::filesystem::path folder(value ? value : "");
  return folder.is_absolute() ? folder : std::filesystem::path();
}

}  // namespace

std::filesystem::path cache_folder() {
  if (const auto cache = folder_in("XDG_CACHE_HOME"); !cache.empty()) return cache / "snowshed";
  const auto home = folder_in("HOME");
  return home.empty() ? home : home / ".cache" / "snowshed";
}

}  // namespace snowshed::gpu
