// The different snows of a scene, which particles refer to by number.
#pragma once

#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// The different snows of the slab and the bodies, in order of their first appearance.
std::vector<material::Snow> distinct_snows(const Scene& scene);

/// The snow of a body or layer.
template <class Part>
const material::Snow& snow_of(const Scene& scene, const Part& part) {
  return part.snow ? *part.snow : scene.snow;
}

/// Index of a snow in `snows`, which must contain it.
int material_id_of(const material::Snow& snow, const std::vector<material::Snow>& snows);

}  // namespace snowshed::scene
