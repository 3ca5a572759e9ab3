// The ranges of nodes that a block's tile shares with each of the 3^D blocks around it, in two and
// three dimensions.
#pragma once

#include <cstring>
#include <type_traits>

#include "snowshed/core/variant.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// The nodes [begin, end) of the block at `offset` (-1, 0, 1) that the tile covers along one
/// direction. Node n of the block is node n + shift of the tile.
template <int D, Basis basis>
struct Overlap {
  int begin, end, shift;
  constexpr explicit Overlap(int offset)
      : begin(offset < 0 ? block_edge<D> - 1 : 0),
        end(offset > 0 ? support(basis) : block_edge<D>),
        shift(offset * block_edge<D> + 1) {}
  /// The overlap along a direction that the dimension lacks.
  static constexpr Overlap none() { return Overlap(0, 1, 0); }

 private:
  constexpr Overlap(int first, int past_last, int by) : begin(first), end(past_last), shift(by) {}
};

/// Calls row(neighbour, block_node, tile_node, length) for each run of consecutive nodes that the
/// tile shares with the neighbours for which wanted(neighbour) is true. The length is a
/// compile-time constant, so that copying a row takes a few vector moves.
template <int D, Basis basis, class Wanted, class Row>
SNOWSHED_INLINE void for_each_shared_row(Wanted wanted, Row row) {
  using Range = Overlap<D, basis>;
  constexpr int B = block_edge<D>, N = tile_edge<D>(basis);
  const auto rows = [&](int neighbour, const Range& x, const Range& y, auto offset) {
    constexpr Range z(decltype(offset)::value);
    if (!wanted(neighbour)) return;
    for (int i = x.begin; i < x.end; ++i)
      for (int j = y.begin; j < y.end; ++j) {
        const int line = D == 3 ? i * B + j : i;
        const int tile_line = D == 3 ? (i + x.shift) * N + j + y.shift : i + x.shift;
        row(neighbour, line * B + z.begin, tile_line * N + z.begin + z.shift,
            std::integral_constant<int, z.end - z.begin>{});
      }
  };
  int neighbour = 0;
  const auto along_last = [&](const Range& x, const Range& y) {
    rows(neighbour++, x, y, std::integral_constant<int, -1>{});
    rows(neighbour++, x, y, std::integral_constant<int, 0>{});
    rows(neighbour++, x, y, std::integral_constant<int, 1>{});
  };
  for (int x = -1; x <= 1; ++x)
    if constexpr (D == 3)
      for (int y = -1; y <= 1; ++y) along_last(Range(x), Range(y));
    else
      along_last(Range(x), Range::none());
}

/// Returns a function of a neighbour: whether particles with these bits of `BlockStats::reach`
/// touch its nodes.
template <int D>
SNOWSHED_INLINE auto touched_by(int reach) {
  return [reach](int neighbour) { return reaches<D>(reach, neighbour); };
}

/// A tile that is cleared only as far as particles reach.
template <class T, int D, Basis basis>
class TileSums {
 public:
  TileSums(T* values, int reach) : values_(values), cleared_(reach) {
    if (cleared_ == everywhere<D>)  // faster than row by row
      std::memset(values_, 0, tile_nodes<D>(basis) * node_values * sizeof(T));
    else
      clear(touched_by<D>(cleared_));
  }

  T* values() const { return values_; }
  /// Returns the bits of `BlockStats::reach` for which nodes are cleared.
  int cleared() const { return cleared_; }

  /// Also clears the nodes that particles with these bits touch.
  void extend(int reach) {
    const auto before = touched_by<D>(cleared_), after = touched_by<D>(cleared_ | reach);
    clear([&](int neighbour) { return after(neighbour) && !before(neighbour); });
    cleared_ |= reach;
  }

 private:
  template <class Wanted>
  void clear(Wanted wanted) {
    for_each_shared_row<D, basis>(wanted, [&](int, int, int node, auto length) {
      std::memset(values_ + node * node_values, 0, length * node_values * sizeof(T));
    });
  }

  T* values_;
  int cleared_;
};

SNOWSHED_MODULE_VARIANT_END
