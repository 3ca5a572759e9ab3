// The coarse grid over which velocities are averaged (velocity_average.hpp): its nodes around each
// block of particles, and the blocks of coarse nodes.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "snowshed/methods/mpm/block_layout.hpp"

namespace snowshed::methods::mpm {

template <int D>
class AverageLayout {
 public:
  static constexpr int edge = D == 3 ? 4 : 8;  // nodes of a coarse block along each direction
  static constexpr int block_nodes = D == 3 ? edge * edge * edge : edge * edge;
  using Coord = std::array<std::int32_t, D>;

  /// A coarse grid of the spacing `length` (m), but of at least half a cell. The particles of a
  /// block stay within `slack` cells of it.
  AverageLayout(double length, double dx, Basis basis, double slack);

  /// Follows a change of the particle blocks. Returns whether they have changed.
  bool connect(const std::vector<BlockKey>& particle_blocks);

  double per_cell() const { return per_cell_; }  ///< dx over the spacing
  /// Share of the difference from the average that velocities lose, over that on a grid whose
  /// spacing is the length. On a coarser grid they diffuse as fast with a smaller share.
  double share_of_length() const { return share_of_length_; }
  int tile_edge() const { return tile_edge_; }      ///< nodes of a tile along each direction
  int around_size() const { return around_size_; }  ///< room for the coarse blocks around a block
  std::size_t size() const { return first_nodes_.size(); }

  /// The first node of a block's tile, and the block's origin past it, in spacings.
  const Coord& first_node(std::size_t block) const { return first_nodes_[block]; }
  const std::array<double, D>& origin(std::size_t block) const { return origins_[block]; }

  const std::vector<Coord>& coarse_blocks() const { return coarse_blocks_; }
  /// The coarse blocks that share the nodes of each block's tile, `around_size` for each, in
  /// lexicographic order; -1: there are no more.
  const std::vector<std::int32_t>& around() const { return around_; }
  /// Coarse block c is shared by the particle blocks sharing[k], first[c] <= k < first[c + 1].
  const std::vector<std::int32_t>& sharing_first() const { return sharing_first_; }
  const std::vector<std::int32_t>& sharing() const { return sharing_; }

 private:
  /// A particle block that shares a coarse block. Fields share none.
  struct BlockShare {
    int field;
    Coord coarse;
    std::int32_t block;
    auto key() const { return std::tie(field, coarse, block); }
    bool operator<(const BlockShare& other) const { return key() < other.key(); }
  };

  double per_cell_, share_of_length_;
  double slack_;  // cells from the block's first node down to its lowest particle
  int tile_edge_, around_size_;
  std::vector<BlockKey> keys_;  // keys of the particle blocks that all arrays below belong to
  std::vector<Coord> first_nodes_;
  std::vector<std::array<double, D>> origins_;
  std::vector<std::int32_t> around_;
  std::vector<Coord> coarse_blocks_;
  std::vector<std::int32_t> sharing_first_, sharing_;
};

}  // namespace snowshed::methods::mpm
