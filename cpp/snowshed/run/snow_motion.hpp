// How the snow of an event will move, by arithmetic alone.
#pragma once

#include "snowshed/methods/cost.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Of a resolved scene: zeros that follow other fields are replaced.
SnowMotion estimate_motion(const Scene& scene);

}  // namespace snowshed
