// The user's folder for files that can be made again.
#pragma once

#include <filesystem>

namespace snowshed::gpu {

/// The folder below XDG_CACHE_HOME, otherwise below ~/.cache; empty if there is no home.
std::filesystem::path cache_folder();

}  // namespace snowshed::gpu
