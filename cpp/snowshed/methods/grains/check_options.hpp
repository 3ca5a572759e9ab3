// Checks that settings, sample and loading of grains fit each other.
#pragma once

#include <vector>

#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::grains {

/// Throws InputError if they do not.
void check_grains(const Options&);

/// Throws InputError where a stage cannot follow those before it: what it undoes must have been
/// done, and what it needs must be there.
void check_stages(const std::vector<LoadingStage>&, const Settings&);

}  // namespace snowshed::grains
