// Estimate of an event's motion by arithmetic alone.
#pragma once

#include "snowshed/methods/cost.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// Requires a resolved scene, in which zeros that stand for values of other fields have been
/// replaced.
methods::SnowMotion estimate_motion(const scene::Scene& scene);

}  // namespace snowshed::run
