// The eight values of a grid node, in as few registers as possible. They form two halves of four
// values: a carried half (mass and momentum, or the velocity), and an acting half (force, or the
// change of velocity).
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <class T>
struct NodeTypes;
template <>
struct NodeTypes<float> {
  static constexpr int register_bytes = simd_bytes < 32 ? simd_bytes : 32;
  typedef float part __attribute__((vector_size(register_bytes), may_alias));
  typedef float half __attribute__((vector_size(16), may_alias));
};
template <>
struct NodeTypes<double> {
  static constexpr int register_bytes = simd_bytes;
  typedef double part __attribute__((vector_size(register_bytes), may_alias));
  typedef double half __attribute__((vector_size(32), may_alias));
};

template <class T>
using NodeHalf = typename NodeTypes<T>::half;

template <class T>
SNOWSHED_INLINE NodeHalf<T> load_half(const T* values) {
  NodeHalf<T> half;
  std::memcpy(&half, values, sizeof half);
  return half;
}
template <class T>
SNOWSHED_INLINE void store_half(T* values, const NodeHalf<T>& half) {
  std::memcpy(values, &half, sizeof half);
}

/// Halves of a node to which an operation applies. A register that holds both halves belongs to
/// both.
enum class Halves { both, first, second };

/// A node's values, or a factor for each of them.
template <class T>
struct Node {
  using Part = typename NodeTypes<T>::part;
  static constexpr int parts = node_values * int(sizeof(T)) / int(sizeof(Part));
  static constexpr int part_values = node_values / parts;
  // Number of the registers that hold the first half.
  static constexpr int first_parts = parts == 1 ? 1 : parts / 2;
  Part part[parts];

  /// All values, or those of the first half.
  template <Halves halves = Halves::both>
  static SNOWSHED_INLINE Node load(const T* values) {
    static_assert(halves != Halves::second);
    Node n;
    for (int i = 0; i < (halves == Halves::first ? first_parts : parts); ++i)
      std::memcpy(&n.part[i], values + i * part_values, sizeof(Part));
    return n;
  }
  /// All values, or those of the first half.
  template <Halves halves = Halves::both>
  SNOWSHED_INLINE void store(T* values) const {
    static_assert(halves != Halves::second);
    if constexpr (halves == Halves::first && parts == 1)
      store_half(values, NodeHalf<T>(__builtin_shufflevector(part[0], part[0], 0, 1, 2, 3)));
    else
      for (int i = 0; i < (halves == Halves::first ? first_parts : parts); ++i)
        std::memcpy(values + i * part_values, &part[i], sizeof(Part));
  }

  /// Returns a node whose first half is filled with `low`, and the second half with `high`.
  static SNOWSHED_INLINE Node of_halves(T low, T high) {
    Node n;
    if constexpr (parts == 1)
      n.part[0] = Part{low, low, low, low, high, high, high, high};
    else
      for (int i = 0; i < parts; ++i) n.part[i] = (i < parts / 2 ? low : high) - Part{};
    return n;
  }
  /// Returns a node with each half from memory, or zero for a null pointer.
  static SNOWSHED_INLINE Node of_halves(const T* low, const T* high) {
    Node n{};
    if constexpr (parts == 1) {
      const NodeHalf<T> zero{};
      n.part[0] = __builtin_shufflevector(low ? load_half(low) : zero,
                                          high ? load_half(high) : zero, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      for (int i = 0; i < parts; ++i) {
        const T* from = i < parts / 2 ? low : high;
        if (from) std::memcpy(&n.part[i], from + i % (parts / 2) * part_values, sizeof(Part));
      }
    }
    return n;
  }
};

template <class T, Halves halves>
inline constexpr int first_part =
    halves == Halves::second && Node<T>::parts > 1 ? Node<T>::first_parts : 0;
template <class T, Halves halves>
inline constexpr int end_part = halves == Halves::first ? Node<T>::first_parts : Node<T>::parts;

/// sum += weight * node, in the registers of some halves; the weight is a number, or a number for
/// each value.
template <Halves halves = Halves::both, class T>
SNOWSHED_INLINE void add_scaled(Node<T>& sum, T weight, const Node<T>& node) {
  for (int i = first_part<T, halves>; i < end_part<T, halves>; ++i)
    sum.part[i] += weight * node.part[i];
}
template <Halves halves = Halves::both, class T>
SNOWSHED_INLINE void add_scaled(Node<T>& sum, const Node<T>& weight, const Node<T>& node) {
  for (int i = first_part<T, halves>; i < end_part<T, halves>; ++i)
    sum.part[i] += weight.part[i] * node.part[i];
}
/// Returns the node with its first half in both halves if one register holds both. Otherwise
/// returns the node itself, because `add_scaled_first` reads the first half's registers anyway.
template <class T>
SNOWSHED_INLINE Node<T> first_twice(const Node<T>& node) {
  if constexpr (Node<T>::parts == 1) {
    Node<T> r;
    r.part[0] = __builtin_shufflevector(node.part[0], node.part[0], 0, 1, 2, 3, 0, 1, 2, 3);
    return r;
  } else {
    return node;
  }
}
/// sum += weight * node, with the first half of the node in place of its second half.
template <class T>
SNOWSHED_INLINE void add_scaled_first(Node<T>& sum, const Node<T>& weight, const Node<T>& node) {
  for (int i = 0; i < Node<T>::parts; ++i)
    sum.part[i] += weight.part[i] * node.part[i % Node<T>::first_parts];
}
/// Returns a - b, in the registers of some halves; the others are undefined.
template <Halves halves = Halves::both, class T>
SNOWSHED_INLINE Node<T> difference(const Node<T>& a, const Node<T>& b) {
  Node<T> r;
  for (int i = first_part<T, halves>; i < end_part<T, halves>; ++i)
    r.part[i] = a.part[i] - b.part[i];
  return r;
}
/// Returns weight * node, in the registers of some halves; the others are zero.
template <Halves halves = Halves::both, class T>
SNOWSHED_INLINE Node<T> scaled(T weight, const Node<T>& node) {
  Node<T> r{};
  for (int i = first_part<T, halves>; i < end_part<T, halves>; ++i)
    r.part[i] = weight * node.part[i];
  return r;
}

SNOWSHED_MODULE_VARIANT_END
