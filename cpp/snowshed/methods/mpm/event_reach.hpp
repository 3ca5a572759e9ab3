// The reach of the particles of a field, with their radii, along the normals of the nodes that it
// shares with another field (equation S7 of docs/methods/mpm-scheme.md).
#pragma once

#include <algorithm>
#include <array>

#include "snowshed/methods/mpm/event_normals.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {

/// The nodes are those of a block and of a margin around it, so that each particle with weight at a
/// node of the block has all its nodes here. They lie in rows along the last direction. A particle
/// takes the same four lanes of each of its rows, because the compiler turns these into one vector.
/// Rows beyond the box of the shared nodes are left out.
template <class T, int D>
class ReachMap {
 public:
  /// Reach along the normals times `sign`.
  ReachMap(const SharedNodes<T, D>& nodes, T sign) : begin_(nodes.begin), end_(nodes.end) {
    std::fill_n(reach_, size, T(-1e9));
    for (int d = 0; d < D; ++d) std::fill_n(normal_[d], size, T(0));
    for_each_index(nodes.begin, nodes.end, [&](const std::array<int, D>& node) {
      const T* normal = nodes.normal[flat_index<D>(node, block_edge<D>)];
      for (int d = 0; d < D; ++d) normal_[d][flat_index<D>(node, edge, -margin)] = sign * normal[d];
    });
  }

  /// Adds a particle at x (cells) whose `support` nodes along each direction begin at `lowest`.
  void add(const T (&x)[D], const std::array<int, D>& lowest, int support, T radius) {
    T radii[lanes];
    for (int l = 0; l < lanes; ++l) radii[l] = l < support ? radius : T(-1e9);
    int first[2] = {}, last[2] = {1, 1};  // range of rows from the lowest node
    for (int d = 0; d < D - 1; ++d) {
      first[d] = std::max(0, begin_[d] - lowest[d]);
      last[d] = std::min(support, end_[d] - lowest[d]);
    }
    const int lowest_row = flat_index<D>(lowest, edge, -margin);
    for (int i = first[0]; i < last[0]; ++i)
      for (int j = first[1]; j < last[1]; ++j) {
        const int row = lowest_row + (D == 3 ? (i * edge + j) * edge : i * edge);
        for (int l = 0; l < lanes; ++l) {
          T along = 0;
          for (int d = 0; d < D; ++d) along += x[d] * normal_[d][row + l];
          reach_[row + l] = std::max(reach_[row + l], along + radii[l]);
        }
      }
  }

  /// The reach at a shared node of the block, in cells.
  T at(const std::array<int, D>& node) const { return reach_[flat_index<D>(node, edge, -margin)]; }

 private:
  static constexpr int lanes = 4;
  static constexpr int margin = lanes - 1;
  static constexpr int edge = block_edge<D> + 2 * margin;
  static constexpr int size = edge * edge * (D == 3 ? edge : 1);
  std::array<int, D> begin_, end_;  // box around the shared nodes
  T normal_[D][size], reach_[size];
};

}  // namespace snowshed::methods::mpm
