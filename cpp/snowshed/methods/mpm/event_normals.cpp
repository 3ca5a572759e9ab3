#include "snowshed/methods/mpm/event_normals.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Index of a node of the block, or of the margin around it, in an array of masses.
template <int D>
int padded_index(const std::array<int, D>& node) {
  return flat_index<D>(node, padded_edge<D>, -normal_margin<D>);
}

/// Adds values to each node of a block along a direction, times the tent around the place `at`.
template <int D, int size>
void spread(const double (&values)[size], int at, double* sums) {
  for (int node = 0; node < block_edge<D>; ++node, sums += size) {
    const int tent = smoothing_tent<D>(at - node);
    for (int k = 0; k < size; ++k) sums[k] += tent * values[k];
  }
}

/// Smooths normals. Without this their direction is arbitrary at the corners of a body, and it
/// would push the body forward. Each normal at a shared node in the box, or around it as far as the
/// smoothing reaches, is spread along one direction after the other, which gives the product of the
/// tents. The sums have the components of a node after each other.
template <class T, int D>
class SmoothedNormals {
 public:
  SmoothedNormals(const std::vector<T>& first, const std::vector<T>& second,
                  const SharedNodes<T, D>& box)
      : first_(first.data()), second_(second.data()) {
    std::array<int, D> node;
    add_along<0, block_nodes<D> * D>(box, node, sums_);
  }

  const double* sums() const { return sums_; }

 private:
  /// Adds the normals along the directions from `d` on. Returns whether there are any.
  template <int d, int size>
  bool add_along(const SharedNodes<T, D>& box, std::array<int, D>& node, double (&sums)[size]) {
    constexpr int part = size / block_edge<D>;
    bool any = false;
    for (int k = box.begin[d] - normal_smoothing<D>; k < box.end[d] + normal_smoothing<D>; ++k) {
      node[d] = k;
      double values[part] = {};
      bool has_normals;
      if constexpr (d + 1 < D)
        has_normals = add_along<d + 1, part>(box, node, values);
      else
        has_normals = find_normal(padded_index<D>(node), values);
      if (!has_normals) continue;
      spread<D, part>(values, k, sums);
      any = true;
    }
    return any;
  }

  bool find_normal(int index, double (&normal)[D]) const {
    const T *const a = first_ + index, *const b = second_ + index;
    return is_shared(*a, *b) && find_weighted_normal(a, b, padded_edge<D>, normal);
  }

  const T *first_, *second_;
  double sums_[block_nodes<D> * D] = {};
};

}  // namespace

template <class T, int D>
SharedNodes<T, D> find_shared_nodes(const std::vector<T>& first, const std::vector<T>& second) {
  SharedNodes<T, D> nodes;
  for_each_index(filled<D>(0), filled<D>(block_edge<D>), [&](const std::array<int, D>& node) {
    if (!is_shared(first[padded_index<D>(node)], second[padded_index<D>(node)])) return;
    nodes.mask |= std::uint64_t(1) << flat_index<D>(node, block_edge<D>);
    for (int d = 0; d < D; ++d) {
      nodes.begin[d] = std::min(nodes.begin[d], node[d]);
      nodes.end[d] = std::max(nodes.end[d], node[d] + 1);
    }
  });
  if (!nodes.mask) return nodes;
  const SmoothedNormals<T, D> normals(first, second, nodes);
  const double* const sums = normals.sums();
  for_each_index(nodes.begin, nodes.end, [&](const std::array<int, D>& node) {
    const int k = flat_index<D>(node, block_edge<D>);
    const double* const sum = sums + k * D;
    double squared = 0;
    for (int d = 0; d < D; ++d) squared += sum[d] * sum[d];
    if (!(squared > 0)) nodes.mask &= ~(std::uint64_t(1) << k);
    for (int d = 0; d < D; ++d) nodes.normal[k][d] = T(sum[d] / std::sqrt(squared));
  });
  return nodes;
}

template SharedNodes<float, 2> find_shared_nodes(const std::vector<float>&,
                                                 const std::vector<float>&);
template SharedNodes<float, 3> find_shared_nodes(const std::vector<float>&,
                                                 const std::vector<float>&);
template SharedNodes<double, 2> find_shared_nodes(const std::vector<double>&,
                                                  const std::vector<double>&);
template SharedNodes<double, 3> find_shared_nodes(const std::vector<double>&,
                                                  const std::vector<double>&);

}  // namespace snowshed::methods::mpm
