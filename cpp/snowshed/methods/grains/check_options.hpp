// Checks that settings, sample and loading of grains fit each other.
#pragma once

#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::grains {

/// Throws InputError if they do not.
void check_grains(const Options&);

}  // namespace snowshed::grains
