// Notes on values of unusual magnitude, which are probably in another unit.
#pragma once

#include <string>
#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Adds a note for each value outside the usual range of its field, such as a preconsolidation
/// pressure of 7 Pa. After a few such notes, one of them counts the rest.
void add_notes_on_unusual_values(const Scene& scene, std::vector<std::string>& notes);

}  // namespace snowshed::scene
