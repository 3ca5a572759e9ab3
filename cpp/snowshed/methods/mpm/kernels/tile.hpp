// Where the nodes of a block's tile come from: the ranges that a tile shares with each of the
// 3^D blocks around it. Written once for two and three dimensions.
#pragma once

#include <type_traits>

#include "snowshed/core/variant.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_VARIANT_BEGIN

/// Along one direction: the nodes [begin, end) of the block at `offset` (-1, 0, 1) that the tile
/// covers; node n is the tile's node n + shift.
template <int D, Basis basis>
struct Overlap {
  int begin, end, shift;
  constexpr explicit Overlap(int offset)
      : begin(offset < 0 ? block_edge<D> - 1 : 0),
        end(offset > 0 ? support(basis) : block_edge<D>),
        shift(offset * block_edge<D> + 1) {}
};

/// Calls row(neighbour, block_node, tile_node, length) for each run of consecutive nodes; the
/// length is a compile-time constant, so that copying a row is a few vector moves.
template <int D, Basis basis, class Row>
SNOWSHED_INLINE void for_each_shared_row(Row row) {
  constexpr int B = block_edge<D>, N = tile_edge<D>(basis);
  int neighbour = 0;
  const auto along_last = [&](int block_base, int tile_base) {
    const auto run = [&](auto offset) {
      constexpr Overlap<D, basis> z(decltype(offset)::value);
      row(neighbour + decltype(offset)::value + 1, block_base + z.begin,
          tile_base + z.begin + z.shift, std::integral_constant<int, z.end - z.begin>{});
    };
    run(std::integral_constant<int, -1>{});
    run(std::integral_constant<int, 0>{});
    run(std::integral_constant<int, 1>{});
  };
  for (int ox = -1; ox <= 1; ++ox) {
    const Overlap<D, basis> x(ox);
    if constexpr (D == 3) {
      for (int oy = -1; oy <= 1; ++oy, neighbour += 3) {
        const Overlap<D, basis> y(oy);
        for (int i = x.begin; i < x.end; ++i)
          for (int j = y.begin; j < y.end; ++j)
            along_last((i * B + j) * B, ((i + x.shift) * N + j + y.shift) * N);
      }
    } else {
      for (int i = x.begin; i < x.end; ++i) along_last(i * B, (i + x.shift) * N);
      neighbour += 3;
    }
  }
}

SNOWSHED_VARIANT_END
