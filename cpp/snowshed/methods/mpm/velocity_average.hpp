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
#include "snowshed/methods/mpm/average_layout.hpp"
#include "snowshed/methods/mpm/average_rule.hpp"
#include "snowshed/methods/mpm/sleep.hpp"

namespace snowshed::methods::mpm {

template <class T, int D>
class VelocityAverage {
 public:
  /// The coarse grid of a length, m (AverageLayout).
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
  static constexpr int edge = AverageLayout<D>::edge;
  static constexpr int block_size = AverageLayout<D>::block_nodes * average_values;

  /// The nodes of a block's tile that its particles reach.
  struct Box {
    std::array<int, D> begin, end;
  };

  void find_tiles();
  Box reached_box(const ParticleView<T>& view, const BlockLayout<D>& layout, std::int32_t b) const;
  void scatter(const Kernels<T>& kernels, const ParticleView<T>& view, const BlockLayout<D>& layout,
               std::int32_t block) noexcept;
  void gather(std::int32_t coarse_block) noexcept;
  template <class Row>
  void for_each_shared_row(std::int32_t coarse_block, std::int32_t block, Row row) const;

  AverageLayout<D> layout_;
  int tile_size_;
  double offset_;                         // cells from a particle to its place on the grid
  std::vector<AverageTile<T>> tiles_of_;  // one per particle block
  std::vector<Box> boxes_;                // one per particle block, valid where its sums are
  bool tiles_fit_ = false;                // false also if there was no memory for them
  std::vector<std::uint8_t> settled_;  // one per particle block: whether its tile's sums stay valid
  std::vector<std::int32_t> needed_;
  std::vector<std::uint8_t> is_needed_;
  AlignedVector<T> tiles_, sums_;
};

}  // namespace snowshed::methods::mpm
