// Pairs of spheres of two bodies that are so near that they may touch before the list is made
// again.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/methods/grains/boundary.hpp"
#include "snowshed/methods/grains/kernel_api.hpp"
#include "snowshed/methods/grains/rotor.hpp"

namespace snowshed::methods::grains {

/// Spheres as parts of rigid bodies.
struct SphereBodies {
  std::vector<Vec3> offsets;         // m, in the bodies' frames
  std::vector<std::uint32_t> grain;  // grain of each sphere
};

struct GrainPose {
  Vec3 position = Vec3::Zero();
  Orientation orientation{1, 0, 0, 0};
};

/// Sphere number of an entry that only fills up its group.
inline constexpr std::uint32_t no_sphere_index = 0xffffffff;

/// Key of a pair: bodies (grains, then `Partner`s), shift of the second body's periodic image (in
/// periods), spheres. Spheres of plates are numbered by their positions in the grid.
struct PairKey {
  std::uint32_t first, second;
  std::int32_t shift[2];
  std::uint32_t a, b;
};
bool operator<(const PairKey&, const PairKey&);
bool operator==(const PairKey&, const PairKey&);

/// The state of a pair that a new list takes over.
struct PairHistory {
  PairKey key;
  Vec3 shear = Vec3::Zero();  // m
  bool bonded = false;
  bool always_listed = false;  // listed at any distance of the spheres
};

/// Groups ordered by bodies, pairs within them by spheres: the order is independent of the search.
struct PairList {
  std::vector<PairGroup> groups;
  AlignedVector<double> ax, ay, az, bx, by, bz, ux, uy, uz;  // see View
  AlignedVector<std::uint8_t> bonded;
  std::vector<std::uint32_t> a, b;

  std::size_t size() const { return a.size(); }
  bool is_pair(std::size_t p) const { return a[p] != no_sphere_index; }
  PairKey key(const PairGroup& g, std::size_t p) const {
    return {g.first, g.second, {g.shift[0], g.shift[1]}, a[p], b[p]};
  }
  Vec3 shear(std::size_t p) const { return {ux[p], uy[p], uz[p]}; }
  /// The bonded pairs, which are always listed, and the sheared pairs, in order.
  std::vector<PairHistory> histories() const;
  /// All pairs, marked as always listed.
  std::vector<PairHistory> all() const;
  std::size_t bytes() const;
};

/// Input of the search.
struct PairSearch {
  const SphereBodies& spheres;
  std::uint32_t grains;
  double radius, skin;  // m
  bool periodic;
  Cone cone;
  std::size_t max_pairs;  // largest number of pairs; more are an error
  int threads;
};

/// The gap below which pairs are listed, over the spheres' radius. A new list is made before a
/// sphere has moved by half of this gap.
inline constexpr double skin_per_radius = 0.4;

/// Centre of a plate's sphere relative to the plate's origin, m.
Vec3 plate_sphere(std::uint32_t number, double radius);

/// All pairs nearer than the skin, ordered. Throws SimulationError if they are more than
/// `max_pairs`, or if the period is too short.
std::vector<PairKey> find_pairs(const PairSearch&, const std::vector<GrainPose>&, const Boundary&);

/// A list of these pairs, and of the pairs in the history that are always listed.
PairList make_list(const PairSearch&, const std::vector<PairKey>&, const std::vector<PairHistory>&);

/// Groups of each grain in list order, coded as 2 · group + (1 if the grain is second).
struct BodyGroups {
  std::vector<std::uint32_t> begin, entry;
};
BodyGroups groups_of_bodies(const PairList&, std::size_t grains);

}  // namespace snowshed::methods::grains
