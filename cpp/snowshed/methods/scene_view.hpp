// A method's view of a scene before anything is built.
#pragma once

#include <optional>
#include <vector>

#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods {

/// The parts of a scene that methods read; it refers to the scene.
struct SceneView {
  int dimension;
  double gravity;  // m/s2, along -z
  const std::optional<TerrainSpec>& terrain;
  const std::optional<SampleSpec>& sample;
  const std::vector<LoadingStage>& loading;
  const std::optional<Cone>& cone;
  const Events& events;
  const Output& output;
};

}  // namespace snowshed::methods
