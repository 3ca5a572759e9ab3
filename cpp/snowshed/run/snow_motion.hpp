// Estimate of an event's motion by arithmetic alone.
#pragma once

#include "snowshed/methods/cost.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Requires a resolved scene: zeros that follow other fields are replaced.
SnowMotion estimate_motion(const Scene& scene);

}  // namespace snowshed
