// Checks of a scene that involve several of its fields.
#pragma once

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Throws InputError at the first part of the scene that the method does not take.
void check_parts(const Scene& scene, const methods::MethodInfo& method);

/// Throws InputError at the first field that contradicts another. Each field must be in its range.
void check_rules(const Scene& scene);

}  // namespace snowshed::scene
