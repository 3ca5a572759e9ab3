// Extent and volume of a described shape by arithmetic, without building its geometry.
#pragma once

#include <optional>

#include "snowshed/scene/scene.hpp"

namespace snowshed::scene {

/// Axis-aligned box around the shape, infinite for a plane; none if it depends on a file.
std::optional<Eigen::AlignedBox3d> shape_bounds(const ShapeSpec& shape);

/// Volume in m3 (in 2D the area of the section, m2); none if it depends on a file. An upper bound
/// for unions, whose parts may overlap, and for differences.
std::optional<double> shape_volume(const ShapeSpec& shape, int dimension);

}  // namespace snowshed::scene
