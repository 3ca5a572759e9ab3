// Filling a solid with particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/level_set.hpp"

namespace snowshed::sampling {

/// The arrangement of the particles of a solid, see `seed`.
enum class SeedPattern { regular, jittered, poisson };

/// The largest number of particles of a solid.
inline constexpr double max_particles = 2e8;

/// Returns particle positions strictly inside the bounded solid `shape`, about `per_voxel` for each
/// voxel of edge `voxel` (metres).
///
/// - regular: the centres of a lattice of spacing voxel / per_voxel^(1/d). A box or plate in any
///   orientation is tiled exactly in its own frame. Its counts are rounded up in each direction, so
///   there are never fewer particles than asked for. Other solids use a lattice along the world
///   axes.
/// - jittered: a random point in each cell of that lattice.
/// - poisson: blue noise (see sample_elimination.hpp) of exactly `expected_count` points.
///
/// The same arguments give the same points. Throws InputError if the solid is unbounded, if it
/// holds no particle, or if it holds more than `max_particles`, and Stopped on request.
std::vector<Vec3> seed(const geometry::LevelSet& shape, int dimension, double voxel,
                       double per_voxel, SeedPattern pattern, std::uint64_t seed,
                       const StopRequest& stop = {});

/// Returns the number of particles that `seed` will place. It is exact for poisson and for boxes,
/// and per_voxel * measure / voxel^d otherwise.
std::size_t expected_count(const geometry::LevelSet& shape, int dimension, double voxel,
                           double per_voxel, SeedPattern pattern);

}  // namespace snowshed::sampling
