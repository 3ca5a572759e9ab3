// Laws of the user in the surroundings of the snow.
#pragma once

#include "snowshed/methods/surroundings.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::run {

/// Gives the obstacles their laws, and the laws to the method. Throws InputError if the scene's
/// method takes no laws of the user, if no obstacle has a name that they use, or if the energy
/// balance would not close.
void apply_laws(const methods::UserLaws& laws, const scene::Scene& scene,
                methods::Surroundings& surroundings);

}  // namespace snowshed::run
