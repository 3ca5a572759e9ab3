// Sorting particles into grid blocks.
#pragma once

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/mpm/particles.hpp"

namespace snowshed::mpm {

/// Where a position (metres) lies: its block, and within it the `cell` coordinates.
template <int D>
struct Placement {
  BlockCoord<D> block;
  std::array<double, D> cell;

  static Placement of(const VecD<D>& position, double dx, Basis basis, int field = 0);
};

/// The position (metres) of cell coordinates in a block.
template <class T, int D>
VecD<D> position_of(const Particles<T, D>& particles, std::size_t i, BlockKey block, double dx,
                    Basis basis) {
  const BlockCoord<D> c = block_coord<D>(block);
  VecD<D> x;
  for (int d = 0; d < D; ++d)
    x[d] = (double(particles.cell[d][i]) + base_offset(basis) + double(c[d]) * block_edge<D>)*dx;
  return x;
}

/// Sorts particles that have moved back into blocks; stable, so the result does not depend on the
/// number of threads. The constructor does all that can fail, and `apply` all that alters
/// particles.
template <class T, int D>
class ParticleSort {
 public:
  /// Finds where the particles belong. `blocks` holds the block that each one's `cell` refers to,
  /// `present` the layout before. Throws SimulationError if one has left the addressable grid
  /// (2^20 blocks to each side) or is not finite.
  ParticleSort(const Particles<T, D>&, std::vector<BlockKey> blocks, const BlockLayout<D>& present,
               int threads);

  /// The layout of the particles once they are sorted; it may be moved away.
  BlockLayout<D> layout;

  /// Sorts the particles that it was made from. Call it once only.
  void apply(Particles<T, D>&) noexcept;

 private:
  int threads_;
  std::vector<std::uint32_t> order_;  // empty: they are in order
  typename Particles<T, D>::Spare spare_;
};

/// The block of each particle in the layout.
template <int D>
std::vector<BlockKey> blocks_of_particles(const BlockLayout<D>&);

}  // namespace snowshed::mpm
