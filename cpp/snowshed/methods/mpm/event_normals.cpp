#include "snowshed/methods/mpm/event_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

template <int D>
struct WeightedNormal {
  std::array<int, D> node;
  VecD<D> normal;  // unit normal times the product of the masses, kg2
};

/// Whether two fields share a node. Its index is that in the block, or in the margin around it.
template <class T, int D>
bool is_shared(const std::vector<T>& first, const std::vector<T>& second,
               const std::array<int, D>& node) {
  const int k = flat_index<D>(node, NormalSmoothing<D>::edge, -NormalSmoothing<D>::margin);
  return double(first[k]) > min_shared_mass && double(second[k]) > min_shared_mass;
}

/// The normals at the shared nodes in a box and around it, as far as the smoothing reaches: the
/// directions of the gradient of the difference of the two masses.
template <class T, int D>
std::vector<WeightedNormal<D>> normals_around(const std::vector<T>& first,
                                              const std::vector<T>& second,
                                              std::array<int, D> begin, std::array<int, D> end) {
  constexpr int edge = NormalSmoothing<D>::edge;
  for (int d = 0; d < D; ++d) {
    begin[d] -= NormalSmoothing<D>::reach;
    end[d] += NormalSmoothing<D>::reach;
  }
  std::vector<WeightedNormal<D>> normals;
  for_each_index(begin, end, [&](const std::array<int, D>& node) {
    if (!is_shared<T, D>(first, second, node)) return;
    const int k = flat_index<D>(node, edge, -NormalSmoothing<D>::margin);
    VecD<D> gradient;
    for (int d = D - 1, stride = 1; d >= 0; --d, stride *= edge)
      gradient[d] = (double(second[k + stride]) - double(second[k - stride])) -
                    (double(first[k + stride]) - double(first[k - stride]));
    const double length = gradient.norm();
    if (length > 0)
      normals.push_back({node, double(first[k]) * double(second[k]) / length * gradient});
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
        const int tent = NormalSmoothing<D>::margin - std::abs(other - node);
        if (tent <= 0) continue;
        const double* const value = values.data() + (i * from.size() + other - from.begin) * after;
        for (int k = 0; k < after; ++k) sum[k] += tent * value[k];
      }
    }
  return sums;
}

/// Smooths normals. Without this their direction is arbitrary at the corners of a body, and it would
/// push the body forward. Sums normals with the product of the tents along all directions, at the nodes from `begin` to
/// `end`. Returns the components of a node after each other.
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
    std::copy_n(n.normal.data(), D, sums.data() + k * D);
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
    if (!is_shared<T, D>(first, second, node)) return;
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
