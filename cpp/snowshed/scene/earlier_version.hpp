// Conversion of scenes from earlier versions of the form to the present one.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace snowshed::scene {

/// Rewrites a scene of an earlier version as one of the present version with the same meaning.
/// Other values stay as they are. Returns notes on changed meanings and names, a sentence each.
std::vector<std::string> update_version(nlohmann::json& scene);

}  // namespace snowshed::scene
