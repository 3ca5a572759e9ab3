// A chunk: as many particles as a SIMD register has lanes. Arithmetic runs across the chunk's
// particles; the transfers run over the nodes of one particle after the other.
#pragma once

#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/kernels/bspline.hpp"
#include "snowshed/methods/mpm/kernels/node.hpp"

SNOWSHED_VARIANT_BEGIN

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
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      SimdPack<T> base;
      for (int l = 0; l < W; ++l) base[l] = std::floor(cell[d][l]);
      outside = outside | (cell[d] < low) | (cell[d] >= high) | (cell[d] != cell[d]);
      reach |= (base < T(0)) & below(d);
      reach |= (base > T(block_edge<D> - S)) & above(d);
      const SimdPack<T> f = cell[d] - base;
      SimdPack<T> w[S], g[S];
      BSpline<basis>::evaluate(f, w, g);
      SNOWSHED_UNROLL
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

/// The same address, kept in a register: nodes are then addressed by constants from it.
template <class P>
SNOWSHED_INLINE P* in_register(P* address) {
  asm("" : "+r"(address));
  return address;
}

/// Weighted sums over a particle's nodes: of the weights, and of their derivative along each
/// direction.
template <class T, int D>
struct NodeSums {
  Node<T> value, along[D];
};

/// sum_i w_i N_i and sum_i (second weight) N_i, innermost direction first. `second` gives for a
/// direction and a node along it what stands in for the weight's derivative; it meets the halves
/// `derived` of a node.
template <Halves derived, class T, int D, Basis basis, class Second>
SNOWSHED_INLINE NodeSums<T, D> interpolate_nodes(const Stencil<T, D, basis>& s, int l,
                                                 const T* tile, Second second) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  const T* nodes = in_register(tile + s.node[l] * node_values);
  NodeSums<T, D> r{};
  const auto along_last = [&](const T* row, Node<T>& a, Node<T>& b) SNOWSHED_INLINE_LAMBDA {
    for (int k = 0; k < S; ++k) {
      const Node<T> node = Node<T>::load(row + k * node_values);
      add_scaled(a, s.weight[D - 1][k][l], node);
      add_scaled<derived>(b, second(D - 1, k), node);
    }
  };
  for (int i = 0; i < S; ++i) {
    const T w = s.weight[0][i][l];
    if constexpr (D == 2) {
      Node<T> a{}, b{};
      along_last(nodes + i * N * node_values, a, b);
      add_scaled(r.value, w, a);
      add_scaled<derived>(r.along[0], second(0, i), a);
      add_scaled<derived>(r.along[1], w, b);
    } else {
      Node<T> value{}, along_y{}, along_z{};
      for (int j = 0; j < S; ++j) {
        Node<T> a{}, b{};
        along_last(nodes + (i * N + j) * N * node_values, a, b);
        add_scaled(value, s.weight[1][j][l], a);
        add_scaled<derived>(along_y, second(1, j), a);
        add_scaled<derived>(along_z, s.weight[1][j][l], b);
      }
      add_scaled(r.value, w, value);
      add_scaled<derived>(r.along[0], second(0, i), value);
      add_scaled<derived>(r.along[1], w, along_y);
      add_scaled<derived>(r.along[2], w, along_z);
    }
  }
  return r;
}

/// Adds w_i value + sum_d (second weight along d) along[d] to each of a particle's nodes. Outside
/// the halves `derived` along[d] is zero.
template <Halves derived, class T, int D, Basis basis, class Second>
SNOWSHED_INLINE void scatter_nodes(const Stencil<T, D, basis>& s, int l, const NodeSums<T, D>& p,
                                   T* tile, Second second) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  T* nodes = in_register(tile + s.node[l] * node_values);
  const auto along_last = [&](T* row, const Node<T>& value, const Node<T>& along_z)
                              SNOWSHED_INLINE_LAMBDA {
                                for (int k = 0; k < S; ++k) {
                                  Node<T> node = Node<T>::load(row + k * node_values);
                                  add_scaled(node, s.weight[D - 1][k][l], value);
                                  add_scaled<derived>(node, second(D - 1, k), along_z);
                                  node.store(row + k * node_values);
                                }
                              };
  for (int i = 0; i < S; ++i) {
    const T wi = s.weight[0][i][l];
    Node<T> value_i = scaled(wi, p.value);
    add_scaled<derived>(value_i, second(0, i), p.along[0]);
    if constexpr (D == 2) {
      along_last(nodes + i * N * node_values, value_i, scaled<derived>(wi, p.along[1]));
    } else {
      const Node<T> along_y = scaled<derived>(wi, p.along[1]);
      const Node<T> along_z = scaled<derived>(wi, p.along[2]);
      for (int j = 0; j < S; ++j) {
        const T wj = s.weight[1][j][l];
        Node<T> value_ij = scaled(wj, value_i);
        add_scaled<derived>(value_ij, second(1, j), along_y);
        along_last(nodes + (i * N + j) * N * node_values, value_ij, scaled<derived>(wj, along_z));
      }
    }
  }
}

SNOWSHED_VARIANT_END
