// Scenes of earlier versions of the form, as the present version says the same.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace snowshed {

/// Rewrites a scene of an earlier version as one of the present version that does the same. Other
/// values stay as they are. Returns what has another meaning or name now, a sentence each.
std::vector<std::string> update_version(nlohmann::json& scene);

}  // namespace snowshed
