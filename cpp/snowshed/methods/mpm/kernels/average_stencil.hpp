// The nodes of a coarse grid around a chunk's particles, over which velocities are averaged. Its
// splines are quadratic, whatever the basis of the grid.
#pragma once

#include <algorithm>

#include "snowshed/methods/mpm/kernels/bspline.hpp"
#include "snowshed/methods/mpm/kernels/chunk.hpp"
#include "snowshed/methods/mpm/kernels/node.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <class T, int D, Basis basis>
class AverageStencil {
 public:
  using V = SimdPack<T>;
  using Half = NodeHalf<T>;

  AverageStencil(const AverageTile<T>& tile, const V (&cell)[D])
      : values_(tile.values), edge_(tile.edge) {
    V index = broadcast<V>(T(0));
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      const V position = (cell[d] + T(base_offset(basis))) * tile.cell + (tile.origin[d] - T(0.5));
      // Rounding may place the outermost particles beyond the tile.
      const V base = clamp(floor(position), broadcast<V>(T(0)), broadcast<V>(T(edge_ - nodes)));
      V w[nodes], slopes[nodes];
      BSpline<Basis::quadratic>::evaluate(V(position - base), w, slopes);
      for (int k = 0; k < nodes; ++k) weights_.set(d, k, w[k]);
      index = index * T(edge_) + base;
    }
    for (int l = 0; l < simd_width<T>; ++l) first_[l] = std::int32_t(index[l]) * average_values;
  }

  /// Adds mass and momentum to the nodes of the particle in a lane.
  SNOWSHED_INLINE void add(int lane, const Half& mass_and_momentum) const {
    for_each_node(lane, [&](T* node, T weight) SNOWSHED_INLINE_LAMBDA {
      store_half(node, Half(load_half(node) + weight * mass_and_momentum));
    });
  }

  /// Returns the weighted sum of the nodes' values.
  SNOWSHED_INLINE Half sum(int lane) const {
    Half total{};
    for_each_node(lane, [&](const T* node, T weight)
                            SNOWSHED_INLINE_LAMBDA { total += weight * load_half(node); });
    return total;
  }

 private:
  static constexpr int nodes = support(Basis::quadratic);

  template <class F>
  SNOWSHED_INLINE void for_each_node(int lane, F f) const {
    for (int i = 0; i < nodes; ++i) {
      const T wi = weights_(0, i, lane);
      for (int j = 0; j < nodes; ++j) {
        const T wij = wi * weights_(1, j, lane);
        T* node = values_ + first_[lane];
        if constexpr (D == 2) {
          f(node + (i * edge_ + j) * average_values, wij);
        } else {
          for (int k = 0; k < nodes; ++k)
            f(node + ((i * edge_ + j) * edge_ + k) * average_values, wij * weights_(2, k, lane));
        }
      }
    }
  }

  T* values_;
  int edge_;
  LaneWeights<T, D, nodes> weights_;
  alignas(64) std::int32_t first_[simd_width<T>];  // index of the lowest node's values
};

/// Adds mass and momentum of a block's particles to the coarse grid.
template <class T, int D, Basis basis>
void scatter_average(const ParticleView<T>& p, int first, int count, const AverageTile<T>& tile) {
  using V = SimdPack<T>;
  for (int at = first; at < first + count; at += simd_width<T>) {
    const int n = std::min(first + count - at, simd_width<T>);
    V cell[D], carried[1 + D];  // mass and momentum
    carried[0] = load(p.mass + at, n);
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      cell[d] = load(p.cell[d] + at, n);
      carried[1 + d] = carried[0] * load(p.velocity[d] + at, n);
    }
    const AverageStencil<T, D, basis> stencil(tile, cell);
    for (int l = 0; l < n; ++l) {
      NodeHalf<T> values{};
      SNOWSHED_UNROLL
      for (int k = 0; k <= D; ++k) values[k] = carried[k][l];
      stencil.add(l, values);
    }
  }
}

SNOWSHED_MODULE_VARIANT_END
