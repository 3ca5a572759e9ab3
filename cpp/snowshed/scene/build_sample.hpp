// From a scene's segmented image to clumps of spheres.
#pragma once

#include <filesystem>

#include "snowshed/methods/grains/clumps.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Reads the image, checks that its clumps fit into memory, and makes them. Throws InputError.
GrainSample build_sample(const SampleSpec&, const std::filesystem::path& base_dir);

}  // namespace snowshed
