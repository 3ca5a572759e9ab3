// Averages of the velocities over a length, towards which velocities are damped. They come from
// sums of mass and momentum on a coarse grid whose spacing is that length, independent of the
// cells. PIC on the cells themselves damps over dx.
//
// As in a step, the particles of each block add to a tile of their own. The coarse grid gathers the
// tiles block by block, in fixed order, and the mean velocities return to the tiles. Only the tiles
// of sleeping blocks, which do not change, outlive a step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/mpm/sleep.hpp"

namespace snowshed::methods::mpm {

/// Number of steps from one damping to the next; each damping stands for all of them. Little
/// changes between them, because snow moves by a fraction of a cell per step, and an average costs
/// a third of a step.
inline constexpr int steps_between_averages = 4;

template <class T, int D>
class VelocityAverage {
 public:
  /// A coarse grid of the spacing `length` (m), but of at least half a cell. On a grid coarser than
  /// `length` a smaller share of the velocities is damped, so that they diffuse as fast.
  VelocityAverage(double length, double dx, Basis basis);

  /// Follows a change of the layout or of the order of the particles.
  void connect(const BlockLayout<D>& layout);

  /// Averages the velocities of all particles. `share` is the part of the difference from the
  /// average that they lose. The next calls must be those of `tile`.
  void update(const Kernels<T>& kernels, const ParticleView<T>& view, const BlockLayout<D>& layout,
              const Sleep<D>& sleep, double share, int threads) noexcept;

  /// The averages around a block that is awake.
  const AverageTile<T>& tile(std::int32_t block);

  std::size_t bytes() const { return (tiles_.capacity() + sums_.capacity()) * sizeof(T); }

 private:
  static constexpr int edge = 4;  // nodes along each direction of a block of the coarse grid
  static constexpr int block_size = (D == 3 ? edge * edge * edge : edge * edge) * average_values;
  using Coord = std::array<std::int32_t, D>;

  void find_blocks(const BlockLayout<D>& layout);
  void scatter(const Kernels<T>& kernels, const ParticleView<T>& view, const BlockLayout<D>& layout,
               std::int32_t block) noexcept;
  void gather(std::int32_t coarse_block) noexcept;
  template <class Row>
  void for_each_shared_row(std::int32_t coarse_block, std::int32_t block, Row row) const;

  double spacing_, per_cell_, share_of_length_;
  double slack_;  // cells from the block's first node down to its lowest particle
  int tile_edge_, tile_size_;
  std::vector<BlockKey> keys_;  // keys of the particle blocks that all arrays below belong to
  std::vector<AverageTile<T>> tiles_of_;  // one per particle block
  std::vector<Coord> first_nodes_;        // first nodes of the tiles, one per particle block
  std::vector<std::uint8_t> settled_;  // one per particle block: whether its tile's sums stay valid
  int around_size_;
  std::vector<std::int32_t> around_;  // the coarse blocks of each particle block
  std::vector<Coord> coarse_blocks_;
  std::vector<std::int32_t> sharing_first_, sharing_;  // the particle blocks of each coarse block
  std::vector<std::int32_t> needed_;
  std::vector<std::uint8_t> is_needed_;
  AlignedVector<T> tiles_, sums_;
};

}  // namespace snowshed::methods::mpm
