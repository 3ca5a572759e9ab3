// Interface between the solver and the kernels: raw views, and one table of functions per
// combination of features. The kernels are compiled once for each instruction set
// (cmake/KernelVariants.cmake), so nothing here may depend on an instruction set.
#pragma once

#include <cstdint>

#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/variant.hpp"
#include "snowshed/material/snow.hpp"
#include "snowshed/methods/contact_law.hpp"
#include "snowshed/methods/mpm/basis.hpp"
#include "snowshed/methods/mpm/contact_rule.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mpm/snow_constants.hpp"
#include "snowshed/methods/mpm/step_energies.hpp"

namespace snowshed::methods::mpm {

/// Nodes along one edge of a grid block.
template <int D>
inline constexpr int block_edge = D == 3 ? 4 : 8;

template <int D>
inline constexpr int block_nodes = block_edge<D> * block_edge<D> * (D == 3 ? block_edge<D> : 1);

/// Values per node, one 256-bit load in single precision.
/// Sums:       mass, momentum (3), force (3), unused.
/// Velocities: new velocity (3), unused, then the change of velocity over the step
///             (FLIP, affine FLIP) or the new velocity again (APIC).
inline constexpr int node_values = 8;

/// Nodes along one edge of a block's tile: the block's own nodes, the nodes outside the block that
/// its particles reach, and one more node on either side. Particles may thus stray by a cell before
/// they must be sorted again.
template <int D>
constexpr int tile_edge(Basis basis) {
  return block_edge<D> + support(basis) + 1;
}
template <int D>
constexpr int tile_nodes(Basis basis) {
  const int n = tile_edge<D>(basis);
  return D == 3 ? n * n * n : n * n;
}

template <int D>
inline constexpr int neighbour_count = D == 3 ? 27 : 9;

/// Particle arrays, structure of arrays. `cell` is the position in cells relative to the block's
/// first node, less base_offset, so that its integer part is the lowest node touched.
template <class T>
struct ParticleView {
  T* cell[3];
  T* velocity[3];
  T* affine[9];             // C, row by row, 1/s; not with FLIP
  T* be_minus_identity[6];  // b_e the elastic left Cauchy-Green tensor
  T* plastic;               // volumetric plastic strain; plastic laws only
  T* mass;
  const std::uint8_t* material_id;  // snow of each particle; only with several materials
  T* own[max_own_numbers];          // numbers of the user's constitutive law
};

/// Values per node of the coarse grid over which velocities are averaged: mass and momentum (3), or
/// an unused value and the mean velocity (3).
inline constexpr int average_values = 4;

/// The part of the coarse grid that the particles of a block reach. It has `edge` nodes along each
/// direction.
template <class T>
struct AverageTile {
  T* values;
  int edge;
  T cell;       // dx over the spacing of the coarse grid
  T origin[3];  // origin of the block, in spacings from its first node
  T share;      // share of the difference from the average that a particle loses
};

template <class T>
struct StepParameters {
  T dt, dx, gravity, flip_ratio;
  T friction_rate;            // dt over the friction memory, see push_and_rub
  T friction_rate_per_speed;  // s/m, the same per m/s of sliding speed
  T overstress;  // share of the stress beyond the yield surface that a step leaves, see CamClayLaw
  const MaterialConstants<T>* snows;  // indexed by material_id
  const T* friction_shares;           // indexed by obstacle, see Contacts::find_friction_shares
  // Whether the contacts still hold the impulses of the step before, which was taken, and not those
  // of a try of this step.
  bool holds_last = false;
  MaterialLaw<T> law = nullptr;               // the user's, in place of those of the snows
  ConstitutiveLaw<T> constitutive = nullptr;  // the user's, in place of law and elasticity
  int own_numbers = 0;                        // for each particle, see UserLaws
};

/// Bits of `BlockStats::reach`: nodes below a block, or above it, along a direction.
constexpr int below(int direction) { return 1 << (2 * direction); }
constexpr int above(int direction) { return 2 << (2 * direction); }
template <int D>
inline constexpr int everywhere = (1 << (2 * D)) - 1;

/// Returns whether particles with these bits of `BlockStats::reach` touch nodes of a neighbour of
/// their block.
template <int D>
constexpr bool reaches(int reach, int neighbour) {
  for (int d = D - 1; d >= 0; --d, neighbour /= 3) {
    if (neighbour % 3 == 0 && !(reach & below(d))) return false;
    if (neighbour % 3 == 2 && !(reach & above(d))) return false;
  }
  return true;
}

/// A kernel's report on one block of particles.
struct BlockStats {
  // Largest square of a particle's velocity or of the grid velocity that moves it, m2/s2.
  double max_speed_squared = 0;
  double strain = 0;          // largest |dt grad v| component; only from `probe`
  int reach = 0;              // blocks around it whose nodes its particles touch
  bool escaped = false;       // a particle left the tile: the sums are not valid, sort first
  std::int32_t unsound = -1;  // a particle strained beyond `elastic_strain_limit`, or not finite
  double elastic_strain = 0;  // elastic strain of that particle
  ParticleEnergies energy{};  // with the energy balance only

  /// Statistics of particles of which only the reach is known.
  static BlockStats reaching(int reach) {
    BlockStats stats;
    stats.reach = reach;
    return stats;
  }
};

/// A kernel's report on one block of nodes.
struct NodeStats {
  double low[3], high[3];               // bounds of the new velocities; low > high: no snow here
  NodeEnergies energy{};                // with the energy balance only
  double impulse[3] = {0.0, 0.0, 0.0};  // N s, by all contacts on the snow, if it is recorded
};

/// Motion that the nodes of a step would have given to a block of sleeping particles: means over
/// its mass.
struct SleepingBlockMotion {
  double speed_squared = 0;            // m2/s2
  double change[3] = {0.0, 0.0, 0.0};  // change of its velocity in the step by all forces, m/s
};

/// Whether a contact has no impulse since the last collection.
template <class T>
bool is_empty(const ContactForce<T>& force) {
  return force.sum[0] == T(0) && force.sum[1] == T(0) && force.sum[2] == T(0);
}

/// Adds the impulse of the step that was just taken to the sum of a contact.
template <class T>
SNOWSHED_INLINE void sum_impulse(ContactForce<T>& force) {
  for (int d = 0; d < 4; ++d) {
    force.sum[d] += force.impulse[d];
    force.impulse[d] = 0;
  }
}

template <class T>
struct Kernels {
  /// Writes the sums of a block's particles, in their present state, to the block's tile.
  void (*scatter)(const StepParameters<T>&, const ParticleView<T>&, int first, int count, T* tile,
                  BlockStats&);
  /// Takes one step of a block's particles with the velocities of the 3^D blocks around it, and
  /// writes their sums for the next step to the tile. `BlockStats::reach` tells where the particles
  /// are, before the step and after it. Elsewhere the values of the tile are undefined. Velocities
  /// are damped towards `average` unless this is null.
  void (*g2p2g)(const StepParameters<T>&, const ParticleView<T>&, int first, int count,
                const T* const* velocities, const AverageTile<T>* average, T* tile, BlockStats&);
  /// Adds mass and momentum of a block's particles to the coarse grid. Null without affine FLIP.
  void (*scatter_average)(const ParticleView<T>&, int first, int count, const AverageTile<T>&);
  /// Finds only the largest |dt grad v| that `g2p2g` would impose. `BlockStats::reach` must tell
  /// where the particles are.
  void (*probe)(const StepParameters<T>&, const ParticleView<T>&, int first, int count,
                const T* const* velocities, BlockStats&);
  /// Adds the tiles of the 3^D particle blocks around (null: none) to a block's node sums.
  void (*gather)(const T* const* tiles, T* sums);
  /// Computes the velocities of nodes from their sums, with forces, gravity and contact. `forces`
  /// receives the impulse of each contact; null: they are not recorded.
  void (*update)(const StepParameters<T>&, const T* sums, T* velocities, Contact<T>* contacts,
                 ContactForce<T>* forces, int contact_count, const ContactLaw*, NodeStats&);
  /// The same in two parts, between which other snow may act. `update_free` applies forces and
  /// gravity, `finish` contact.
  void (*update_free)(const StepParameters<T>&, const T* sums, T* velocities);
  void (*finish)(const StepParameters<T>&, const T* sums, T* velocities, Contact<T>* contacts,
                 ContactForce<T>* forces, int contact_count, const ContactLaw*, NodeStats&);
  /// Computes the motion that the 3^D blocks of nodes around (null: at rest) would give to the snow
  /// on a tile. `reach` tells where its particles are.
  void (*carried_motion)(const T* tile, int reach, const T* const* sums, const T* const* velocities,
                         SleepingBlockMotion&);
};

struct KernelChoice {
  int dimension;
  Transfer transfer;
  Basis basis;
  material::SnowModel model;  // the model of the only snow
  bool several_materials = false;
  bool energy = false;
  bool regularised = false;  // Cam-Clay with a crack band or a relaxation time

  /// Returns whether the kernels for checks are used, which have all features. With FLIP and APIC,
  /// only these kernels have the regularised law.
  bool checks() const { return energy || (regularised && transfer != Transfer::affine_flip); }
  /// Returns whether the kernels look up each particle's material, which may have any model. The
  /// kernels for checks always do, so that they need not be compiled for each model.
  bool material_per_particle() const { return several_materials || checks(); }
};

/// Returns the best build of the chosen kernels for this machine, or the one that SNOWSHED_KERNELS
/// names.
template <class T>
Kernels<T> select_kernels(const KernelChoice&);

}  // namespace snowshed::methods::mpm
