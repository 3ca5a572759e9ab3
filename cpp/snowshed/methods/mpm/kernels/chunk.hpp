// A chunk: as many particles as a SIMD register has lanes. Arithmetic runs across the chunk's
// particles; the transfers run over the nodes of one particle after the other, a node's eight
// values in one register.
#pragma once

#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/kernels/bspline.hpp"

SNOWSHED_VARIANT_BEGIN

template <class T>
struct NodeTypes;
template <>
struct NodeTypes<float> {
  typedef float type __attribute__((vector_size(32), may_alias, aligned(32)));
};
template <>
struct NodeTypes<double> {
  typedef double type __attribute__((vector_size(64), may_alias, aligned(64)));
};
/// The eight values of a node.
template <class T>
using Node = typename NodeTypes<T>::type;

/// Weights of a chunk and where each particle's nodes begin in the tile.
template <class T, int D, Basis basis>
struct Stencil {
  static constexpr int S = support(basis);
  static constexpr int W = simd_width<T>;
  alignas(64) T weight[D][S][W];
  alignas(64) T gradient[D][S][W];  // per cell
  alignas(64) T fraction[D][W];
  alignas(64) std::int32_t node[W];
  bool inside;        // every particle's nodes lie in the tile
  SimdMask<T> reach;  // in each lane, the bits of BlockStats::reach

  SNOWSHED_INLINE void place(const SimdPack<T> (&cell)[D], int n) {
    constexpr int N = tile_edge<D>(basis);
    constexpr T low = -1, high = T(block_edge<D> + 1);
    SimdPack<T> index = broadcast<SimdPack<T>>(T(0));
    auto outside = cell[0] < low;
    reach = SimdMask<T>{};
    for (int d = 0; d < D; ++d) {
      SimdPack<T> base;
      for (int l = 0; l < W; ++l) base[l] = std::floor(cell[d][l]);
      outside = outside | (cell[d] < low) | (cell[d] >= high) | (cell[d] != cell[d]);
      reach |= (base < T(0)) & below(d);
      reach |= (base > T(block_edge<D> - S)) & above(d);
      const SimdPack<T> f = cell[d] - base;
      SimdPack<T> w[S], g[S];
      BSpline<basis>::evaluate(f, w, g);
      for (int k = 0; k < S; ++k) {
        std::memcpy(weight[d][k], &w[k], sizeof w[k]);
        std::memcpy(gradient[d][k], &g[k], sizeof g[k]);
      }
      std::memcpy(fraction[d], &f, sizeof f);
      index = index * T(N) + (base + T(1));
    }
    inside = true;
    if (any(outside))
      for (int l = 0; l < n; ++l) inside = inside && !outside[l];
    if (inside)
      for (int l = 0; l < W; ++l) node[l] = std::int32_t(index[l]);
  }

  /// Distance from lane l's particle to its k-th node along d, in cells.
  SNOWSHED_INLINE T arm(int d, int k, int l) const {
    return T(k) - fraction[d][l] - T(base_offset(basis));
  }
};

/// Weighted sums over a particle's nodes: of the weights, and of their derivative along each
/// direction. `second` holds, for each direction and node, what stands in for the derivative.
template <class T, int D>
struct NodeSums {
  Node<T> value, along[D];
};

/// sum_i w_i N_i and sum_i (second weight) N_i, innermost direction first.
template <class T, int D, Basis basis, class Second>
SNOWSHED_INLINE NodeSums<T, D> interpolate_nodes(const Stencil<T, D, basis>& s, int l,
                                                 const T* tile, Second second) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  const Node<T>* nodes = reinterpret_cast<const Node<T>*>(tile) + s.node[l];
  NodeSums<T, D> r{};
  for (int i = 0; i < S; ++i) {
    if constexpr (D == 2) {
      Node<T> a{}, b{};
      for (int k = 0; k < S; ++k) {
        const Node<T> node = nodes[i * N + k];
        a += s.weight[1][k][l] * node;
        b += second(1, k) * node;
      }
      const T w = s.weight[0][i][l];
      r.value += w * a;
      r.along[0] += second(0, i) * a;
      r.along[1] += w * b;
    } else {
      Node<T> value{}, along_y{}, along_z{};
      for (int j = 0; j < S; ++j) {
        Node<T> a{}, b{};
        for (int k = 0; k < S; ++k) {
          const Node<T> node = nodes[(i * N + j) * N + k];
          a += s.weight[2][k][l] * node;
          b += second(2, k) * node;
        }
        const T w = s.weight[1][j][l];
        value += w * a;
        along_y += second(1, j) * a;
        along_z += w * b;
      }
      const T w = s.weight[0][i][l];
      r.value += w * value;
      r.along[0] += second(0, i) * value;
      r.along[1] += w * along_y;
      r.along[2] += w * along_z;
    }
  }
  return r;
}

/// Adds w_i value + sum_d (second weight along d) along[d] to each of a particle's nodes.
template <class T, int D, Basis basis, class Second>
SNOWSHED_INLINE void scatter_nodes(const Stencil<T, D, basis>& s, int l, const NodeSums<T, D>& p,
                                   T* tile, Second second) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  Node<T>* nodes = reinterpret_cast<Node<T>*>(tile) + s.node[l];
  for (int i = 0; i < S; ++i) {
    const T wi = s.weight[0][i][l];
    const Node<T> value_i = wi * p.value + second(0, i) * p.along[0];
    if constexpr (D == 2) {
      const Node<T> along_z = wi * p.along[1];
      for (int k = 0; k < S; ++k)
        nodes[i * N + k] += s.weight[1][k][l] * value_i + second(1, k) * along_z;
    } else {
      const Node<T> along_y = wi * p.along[1], along_z = wi * p.along[2];
      for (int j = 0; j < S; ++j) {
        const T wj = s.weight[1][j][l];
        const Node<T> value_ij = wj * value_i + second(1, j) * along_y;
        const Node<T> along_z_ij = wj * along_z;
        for (int k = 0; k < S; ++k)
          nodes[(i * N + j) * N + k] += s.weight[2][k][l] * value_ij + second(2, k) * along_z_ij;
      }
    }
  }
}

SNOWSHED_VARIANT_END
