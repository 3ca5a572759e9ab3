// Checks that settings, sample and loading of grains fit each other.
#pragma once

#include <vector>

#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::methods::grains {

/// Throws InputError if settings, sample and loading do not fit each other.
void check_grains(const Options&);

/// Throws InputError if a stage cannot follow those before it, such as an unloading without a load.
void check_stages(const std::vector<LoadingStage>&, const Settings&);

}  // namespace snowshed::methods::grains
