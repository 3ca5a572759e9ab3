// A scene with a panel, a slab and the ground.
#pragma once

#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Tilts in degrees.
inline Scene panel_scene(double tilt, double ground_tilt = 0.0) {
  Scene scene;
  Panel& panel = scene.panel.emplace();
  panel.height = 0.5;
  panel.length = 2.0;
  panel.width = 3.0;
  panel.tilt = tilt;
  scene.slab.emplace().thickness = 0.1;
  scene.ground.emplace().tilt = ground_tilt;
  scene.numerics.as<methods::mpm::Settings>().dx = 0.01;
  return scene;
}

}  // namespace snowshed::scene
