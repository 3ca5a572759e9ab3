// Nodes of a block that the snow of two events shares, and the normals between them there (equation
// S6 of docs/methods/mpm-scheme.md).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/block_layout.hpp"
#include "snowshed/methods/mpm/event_rule.hpp"

namespace snowshed::methods::mpm {

/// Nodes along each direction of a block with the margin around it, and all of them.
template <int D>
inline constexpr int padded_edge = block_edge<D> + 2 * normal_margin<D>;
template <int D>
inline constexpr int padded_nodes = padded_edge<D> * padded_edge<D> * (D == 3 ? padded_edge<D> : 1);

/// An index with the same value along each direction.
template <int D>
constexpr std::array<int, D> filled(int value) {
  std::array<int, D> index{};
  for (int d = 0; d < D; ++d) index[d] = value;
  return index;
}

/// Returns the flat index in an array with `edge` elements along each direction, whose indices
/// begin at `low`.
template <int D>
int flat_index(const std::array<int, D>& index, int edge, int low = 0) {
  int flat = 0;
  for (int d = 0; d < D; ++d) flat = flat * edge + index[d] - low;
  return flat;
}

template <class T, int D>
struct SharedNodes {
  std::uint64_t mask = 0;  // a bit for each node of the block
  std::array<int, D> begin = filled<D>(block_edge<D>), end = filled<D>(0);  // box around these
  T normal[block_nodes<D>][3] = {};  // from the first field to the second

  bool contains(int node) const { return mask >> node & 1; }
};

/// Finds the nodes that two fields share. `first` and `second` are their masses (kg) at the nodes
/// of the block and of the margin around it.
template <class T, int D>
SharedNodes<T, D> find_shared_nodes(const std::vector<T>& first, const std::vector<T>& second);

}  // namespace snowshed::methods::mpm
