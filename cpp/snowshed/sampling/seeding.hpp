// Filling a solid with particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

/// How the particles of a solid are arranged, see `seed`.
enum class SeedPattern { regular, jittered, poisson };

/// More particles than this are refused.
inline constexpr double max_particles = 2e8;

/// Particle positions strictly inside the bounded solid `shape`, about `per_voxel` for each
/// voxel of edge `voxel` (metres).
///
/// - regular: the centres of a lattice of spacing voxel / per_voxel^(1/d). A box or plate, in
///   any orientation, is tiled exactly in its own frame, with the counts rounded up in each
///   direction and so never fewer particles than asked for; other solids use a lattice along
///   the world axes.
/// - jittered: a random point in each cell of that lattice.
/// - poisson: blue noise (see sample_elimination.hpp) with exactly the `expected_count`.
///
/// The same arguments give the same points. Throws InputError if the solid is unbounded or
/// holds no particle or more than `max_particles`.
std::vector<Vec3> seed(const LevelSet& shape, int dimension, double voxel, double per_voxel,
                       SeedPattern pattern, std::uint64_t seed);

/// How many particles `seed` will place, without placing them: exact for poisson and for
/// boxes, per_voxel * measure / voxel^d otherwise.
std::size_t expected_count(const LevelSet& shape, int dimension, double voxel, double per_voxel,
                           SeedPattern pattern);

}  // namespace snowshed
