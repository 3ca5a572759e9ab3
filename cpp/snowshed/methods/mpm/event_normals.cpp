#include "snowshed/methods/mpm/event_normals.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

template <int D>
struct WeightedNormal {
  std::array<int, D> node;
  double normal[D];  // see find_weighted_normal
};

/// Index of a node of the block, or of the margin around it, in an array of masses.
template <int D>
int padded_index(const std::array<int, D>& node) {
  return flat_index<D>(node, padded_edge<D>, -normal_margin<D>);
}

/// The normals at the shared nodes in a box and around it, as far as the smoothing reaches.
template <class T, int D>
std::vector<WeightedNormal<D>> normals_around(const std::vector<T>& first,
                                              const std::vector<T>& second,
                                              std::array<int, D> begin, std::array<int, D> end) {
  for (int d = 0; d < D; ++d) {
    begin[d] -= normal_smoothing<D>;
    end[d] += normal_smoothing<D>;
  }
  std::vector<WeightedNormal<D>> normals;
  for_each_index(begin, end, [&](const std::array<int, D>& node) {
    const T* const a = first.data() + padded_index<D>(node);
    const T* const b = second.data() + padded_index<D>(node);
    WeightedNormal<D> weighted{node, {}};
    if (is_shared(*a, *b) && find_weighted_normal(a, b, padded_edge<D>, weighted.normal))
      normals.push_back(weighted);
  });
  return normals;
}

struct Span {
  int begin, end;
  int size() const { return end - begin; }
};

/// Sums values along one direction, weighted by tents around the nodes of `to`. `before` and
/// `after` are the numbers of values along the other directions.
template <int D>
std::vector<double> smoothed(const std::vector<double>& values, int before, Span from, Span to,
                             int after) {
  std::vector<double> sums(std::size_t(before * to.size() * after));
  for (int i = 0; i < before; ++i)
    for (int node = to.begin; node < to.end; ++node) {
      double* const sum = sums.data() + (i * to.size() + node - to.begin) * after;
      for (int other = from.begin; other < from.end; ++other) {
        const int tent = smoothing_tent<D>(other - node);
        if (tent == 0) continue;
        const double* const value = values.data() + (i * from.size() + other - from.begin) * after;
        for (int k = 0; k < after; ++k) sum[k] += tent * value[k];
      }
    }
  return sums;
}

/// Smooths normals. Without this their direction is arbitrary at the corners of a body, and it
/// would push the body forward. Sums normals with the product of the tents along all directions, at
/// the nodes from `begin` to `end`. Returns the components of a node after each other.
template <int D>
std::vector<double> smoothed(const std::vector<WeightedNormal<D>>& normals,
                             const std::array<int, D>& begin, const std::array<int, D>& end) {
  std::array<int, D> low = normals.front().node, high = low;
  for (const WeightedNormal<D>& n : normals)
    for (int d = 0; d < D; ++d) {
      low[d] = std::min(low[d], n.node[d]);
      high[d] = std::max(high[d], n.node[d] + 1);
    }
  int size = D;
  for (int d = 0; d < D; ++d) size *= high[d] - low[d];
  std::vector<double> sums(std::size_t(size), 0.0);
  for (const WeightedNormal<D>& n : normals) {
    int k = 0;
    for (int d = 0; d < D; ++d) k = k * (high[d] - low[d]) + n.node[d] - low[d];
    std::copy_n(n.normal, D, sums.data() + k * D);
  }
  for (int d = 0, before = 1, after = size; d < D; ++d) {
    after /= high[d] - low[d];
    sums = smoothed<D>(sums, before, {low[d], high[d]}, {begin[d], end[d]}, after);
    before *= end[d] - begin[d];
  }
  return sums;
}

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
  const auto normals = normals_around<T, D>(first, second, nodes.begin, nodes.end);
  if (normals.empty()) return {};
  const std::vector<double> sums = smoothed<D>(normals, nodes.begin, nodes.end);
  const double* sum = sums.data();
  for_each_index(nodes.begin, nodes.end, [&](const std::array<int, D>& node) {
    const int k = flat_index<D>(node, block_edge<D>);
    double squared = 0;
    for (int d = 0; d < D; ++d) squared += sum[d] * sum[d];
    if (!(squared > 0)) nodes.mask &= ~(std::uint64_t(1) << k);
    for (int d = 0; d < D; ++d) nodes.normal[k][d] = T(sum[d] / std::sqrt(squared));
    sum += D;
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
