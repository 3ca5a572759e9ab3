// The bodies of snow that a scene brings in each event, as descriptions: the slab's layers on the
// panel, then the scene's own bodies.
#pragma once

#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Whether a layer or body is laid at the start of `event` (1 is the first).
template <class Part>
bool is_added_in(const Part& part, int event) {
  return part.event == 0 || part.event == event;
}

/// The slab's layers; a slab that is given by its thickness has a single layer.
std::vector<Layer> layers_of(const Slab& slab);

/// The slab laid at the start of `event`, from the panel upwards, a body for each of its layers.
/// Its underside is `lift` metres (>= 0) above the panel, measured along the normal: later slabs
/// lie on the snow that remained there.
std::vector<BodySpec> slab_bodies(const Scene& scene, int event, double lift = 0.0);

/// The thickness of the slab laid at the start of `event`, m.
double slab_thickness(const Slab& slab, int event);

/// The bodies that appear at the start of `event`: the slab, then the scene's bodies of that event.
std::vector<BodySpec> event_bodies(const Scene& scene, int event, double lift = 0.0);

}  // namespace snowshed::scene
