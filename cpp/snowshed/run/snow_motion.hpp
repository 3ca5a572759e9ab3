// Estimate of an event's motion by arithmetic alone.
#pragma once

#include "snowshed/methods/cost.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// Requires a resolved scene: zeros that follow other fields are replaced.
methods::SnowMotion estimate_motion(const scene::Scene& scene);

}  // namespace snowshed::run
