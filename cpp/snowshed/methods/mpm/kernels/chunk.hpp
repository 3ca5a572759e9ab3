// A chunk: as many particles as a SIMD register has lanes. Arithmetic runs across the chunk's
// particles; the transfers run over the nodes of one particle after the other.
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Positions of the nodes of a chunk's particles in the tile.
template <class T, int D, Basis basis>
struct Stencil {
  using V = SimdPack<T>;
  static constexpr int S = support(basis);
  static constexpr int W = simd_width<T>;
  V fraction[D];                        // in cells, past the lowest node plus base_offset
  alignas(64) std::int32_t address[W];  // address of the lowest node, in values
  bool inside;                          // whether all nodes of all particles lie in the tile
  SimdMask<T> reach;                    // in each lane, the bits of BlockStats::reach

  /// Lanes beyond the last particle must repeat the first one, as `load` does.
  SNOWSHED_INLINE explicit Stencil(const V (&cell)[D]) {
    constexpr int N = tile_edge<D>(basis);
    constexpr T low = -1, high = T(block_edge<D> + 1);
    V index = broadcast<V>(T(0));
    auto outside = cell[0] < low;
    reach = SimdMask<T>{};
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      const V base = floor(cell[d]);
      outside = outside | (cell[d] < low) | (cell[d] >= high) | (cell[d] != cell[d]);
      reach |= (base < T(0)) & below(d);
      reach |= (base > T(block_edge<D> - S)) & above(d);
      fraction[d] = cell[d] - base;
      index = index * T(N) + (base + T(1));
    }
    inside = !any(outside);
    if (inside)
      for (int l = 0; l < W; ++l) address[l] = std::int32_t(index[l]) * node_values;
  }
};

/// The weight of each particle of a chunk for each of `count` nodes (or steps between nodes) along
/// each direction.
template <class T, int D, int count>
struct LaneWeights {
  static constexpr int W = simd_width<T>;
  alignas(64) T weight[D][count][W];

  SNOWSHED_INLINE void set(int d, int k, const SimdPack<T>& lanes) {
    std::memcpy(weight[d][k], &lanes, sizeof lanes);
  }
  SNOWSHED_INLINE T operator()(int d, int k, int lane) const { return weight[d][k][lane]; }
};

SNOWSHED_MODULE_VARIANT_END
