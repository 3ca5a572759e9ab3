// Sorting particles into grid blocks.
#pragma once

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/mpm/particles.hpp"

namespace snowshed::methods::mpm {

/// The block in which a position (m) lies, and the `cell` coordinates within this block.
template <int D>
struct Placement {
  BlockCoord<D> block;
  std::array<double, D> cell;

  static Placement of(const VecD<D>& position, double dx, Basis basis, int field = 0);
};

/// Returns the position (m) of a particle whose `cell` refers to `block`.
template <class T, int D>
VecD<D> position_of(const Particles<T, D>& particles, std::size_t i, BlockKey block, double dx,
                    Basis basis) {
  const BlockCoord<D> c = block_coord<D>(block);
  VecD<D> x;
  for (int d = 0; d < D; ++d)
    x[d] = (double(particles.cell[d][i]) + base_offset(basis) + double(c[d]) * block_edge<D>)*dx;
  return x;
}

/// Sorts particles into blocks after they have moved. The sort is stable, so the result does not
/// depend on the number of threads. Everything that can fail happens in the constructor. Only
/// `apply` changes the particles.
template <class T, int D>
class ParticleSort {
 public:
  /// Finds the blocks of the particles. `blocks` holds the block to which the `cell` of each
  /// particle refers, and `present` is the layout before the sort. Throws SimulationError if a
  /// particle has left the addressable grid (2^20 blocks to each side) or is not finite.
  ParticleSort(const Particles<T, D>&, std::vector<BlockKey> blocks, const BlockLayout<D>& present,
               int threads);

  /// The layout of the particles once they are sorted; it may be moved away.
  BlockLayout<D> layout;

  /// Sorts the particles that were given to the constructor. Call it only once.
  void apply(Particles<T, D>&) noexcept;

 private:
  int threads_;
  std::vector<std::uint32_t> order_;  // empty if the particles are in order
  typename Particles<T, D>::Spare spare_;
};

/// Returns the block of each particle in the layout.
template <int D>
std::vector<BlockKey> blocks_of_particles(const BlockLayout<D>&);

}  // namespace snowshed::methods::mpm
