// Weighted sums of a particle over its nodes, to and from the grid, one direction after the other.
// The rule of a transfer (transfer_rules.hpp) weights the derivatives.
#pragma once

#include "snowshed/methods/mpm/kernels/node.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Returns the same address, kept in a register. Nodes are then addressed by constant offsets from
/// it.
template <class P>
SNOWSHED_INLINE P* in_register(P* address) {
  asm("" : "+r"(address));
  return address;
}

/// Sums of node values over a particle's nodes, with the weights (`value`) and with their
/// derivatives along each direction (`along`).
template <class T, int D>
struct NodeSums {
  Node<T> value, along[D];
};

/// The nodes along a line, stored as the second node and the steps from each node to the next.
/// Weights add up to one, and their derivatives to zero. Sums over steps are therefore exact for
/// constant values, and take fewer multiplications. Only `halves` of the values count.
template <class T, int S, Halves halves>
struct Line {
  Node<T> second, step[S - 1];

  SNOWSHED_INLINE explicit Line(const Node<T> (&nodes)[S]) : second(nodes[1]) {
    for (int k = 0; k + 1 < S; ++k) step[k] = difference<halves>(nodes[k + 1], nodes[k]);
  }

  /// Returns the sum along direction d, weighted for the particle in `lane`. `weights` are the
  /// weights of the steps.
  template <class Weights>
  SNOWSHED_INLINE Node<T> value(const Weights& weights, int d, int lane) const {
    Node<T> sum = second;
    for (int k = 0; k + 1 < S; ++k) add_scaled<halves>(sum, weights(d, k, lane), step[k]);
    return sum;
  }
};

/// Returns the sums of the particle in a lane, whose lowest node is at `nodes`.
template <class Rule, class T, int D, Basis basis>
SNOWSHED_INLINE NodeSums<T, D> interpolate_nodes(const typename Rule::Interpolation& weights,
                                                 int lane, const T* nodes) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  using Values = Line<T, S, Rule::taken>;
  using Derivatives = Line<T, S, Rule::interpolated>;
  nodes = in_register(nodes);
  // Sums over the line or plane of nodes at each node along the first direction.
  Node<T> value[S], along[D][S];
  const auto along_last = [&](const T* row, Node<T>& a, Node<T>& b) SNOWSHED_INLINE_LAMBDA {
    Node<T> node[S];
    for (int k = 0; k < S; ++k)
      node[k] = Node<T>::template load<Rule::taken>(row + k * node_values);
    const Values line(node);
    a = line.value(weights.value, D - 1, lane);
    b = weights.derivative(line, D - 1, lane);
  };
  for (int i = 0; i < S; ++i) {
    if constexpr (D == 2) {
      along_last(nodes + i * N * node_values, value[i], along[1][i]);
    } else {
      Node<T> a[S], b[S];
      for (int j = 0; j < S; ++j) along_last(nodes + (i * N + j) * N * node_values, a[j], b[j]);
      const Values line(a);
      value[i] = line.value(weights.value, 1, lane);
      along[1][i] = weights.derivative(line, 1, lane);
      along[2][i] = Derivatives(b).value(weights.value, 1, lane);
    }
  }
  const Values line(value);
  NodeSums<T, D> sums;
  sums.value = line.value(weights.value, 0, lane);
  sums.along[0] = weights.derivative(line, 0, lane);
  for (int d = 1; d < D; ++d) sums.along[d] = Derivatives(along[d]).value(weights.value, 0, lane);
  return sums;
}

/// Adds to each node of the particle in a lane its share of `sums`: the value times the weight, and
/// the values of `along` times the weight's derivatives. Outside the halves that the rule scatters,
/// along[d] is zero.
template <class Rule, class T, int D, Basis basis>
SNOWSHED_INLINE void scatter_nodes(const typename Rule::Scattering& weights, int lane,
                                   const NodeSums<T, D>& sums, T* nodes) {
  constexpr int S = support(basis), N = tile_edge<D>(basis);
  constexpr Halves derived = Rule::scattered;
  nodes = in_register(nodes);
  const auto along_last = [&](T* row, const Node<T>& value,
                              const Node<T>& along_z) SNOWSHED_INLINE_LAMBDA {
    for (int k = 0; k < S; ++k) {
      Node<T> node = Node<T>::load(row + k * node_values);
      add_scaled(node, weights.value(D - 1, k, lane), value);
      add_scaled<derived>(node, weights.derived(D - 1, k, lane), along_z);
      node.store(row + k * node_values);
    }
  };
  for (int i = 0; i < S; ++i) {
    const T wi = weights.value(0, i, lane);
    Node<T> value_i = scaled(wi, sums.value);
    add_scaled<derived>(value_i, weights.derived(0, i, lane), sums.along[0]);
    if constexpr (D == 2) {
      along_last(nodes + i * N * node_values, value_i, scaled<derived>(wi, sums.along[1]));
    } else {
      const Node<T> along_y = scaled<derived>(wi, sums.along[1]);
      const Node<T> along_z = scaled<derived>(wi, sums.along[2]);
      for (int j = 0; j < S; ++j) {
        const T wj = weights.value(1, j, lane);
        Node<T> value_ij = scaled(wj, value_i);
        add_scaled<derived>(value_ij, weights.derived(1, j, lane), along_y);
        along_last(nodes + (i * N + j) * N * node_values, value_ij, scaled<derived>(wj, along_z));
      }
    }
  }
}

SNOWSHED_MODULE_VARIANT_END
