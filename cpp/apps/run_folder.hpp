// Running all events of a scene into a results folder.
#pragma once

#include <filesystem>
#include <functional>

#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Runs `scene` into `folder`: new or empty, or with a checkpoint to `resume` from. Returns false
/// where `go_on`, asked several times a second, stopped it; a checkpoint is in the folder then,
/// and also after a SimulationError.
bool run_into_folder(const Scene& scene, const std::filesystem::path& folder, bool resume,
                     bool quiet, const std::function<bool()>& go_on);

}  // namespace snowshed
