// The nearest point of a triangle mesh to a given point.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// The feature of a triangle that is nearest to a point: a vertex, the edge from vertex i to i + 1,
/// or the face.
enum class Feature : std::uint8_t { vertex0, vertex1, vertex2, edge0, edge1, edge2, face };

struct Nearest {
  double squared_distance = infinity;
  Vec3 point = Vec3::Zero();
  std::uint32_t triangle = 0;
  Feature feature = Feature::face;
};

/// Returns the nearest point of triangle abc to p and its feature, from the Voronoi region that
/// contains p (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
inline std::pair<Vec3, Feature> nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                    const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, Feature::vertex0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, Feature::vertex1};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, Feature::vertex2};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, Feature::edge0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, Feature::edge2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Feature::edge1};
  const double sum = va + vb + vc;
  return {a + vb / sum * ab + vc / sum * ac, Feature::face};
}

/// Bounding volume hierarchy over the triangles, split at the median; its depth is log2 n.
class TriangleHierarchy {
 public:
  explicit TriangleHierarchy(const TriangleMesh& mesh)
      : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, static_cast<std::uint32_t>(order_.size()));
  }

  /// Returns the nearest point of the mesh to x. If no point has a squared distance below the limit
  /// (m2), returns the limit as the squared distance.
  Nearest nearest(const Vec3& x, double squared_limit = infinity) const {
    Nearest best;
    best.squared_distance = squared_limit;
    std::uint32_t stack[2 * max_depth];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (squared_distance(node.bounds, x) >= best.squared_distance) continue;
      if (node.second == 0) {
        for (std::uint32_t n = node.begin; n < node.end; ++n) improve(x, order_[n], best);
        continue;
      }
      std::uint32_t near = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      std::uint32_t far = node.second;
      if (squared_distance(nodes_[far].bounds, x) < squared_distance(nodes_[near].bounds, x))
        std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
    }
    return best;
  }

  const Bounds& bounds() const { return nodes_.front().bounds; }

 private:
  static constexpr int max_depth = 40;
  static constexpr std::uint32_t leaf_size = 4;

  /// A node holds the triangles order_[begin, end). Its first child follows it in nodes_, its
  /// second child is nodes_[second]. Leaves have second = 0.
  struct Node {
    Bounds bounds;
    std::uint32_t begin, end, second;
  };

  Vec3 corner(std::uint32_t triangle, int i) const {
    return mesh_.vertices[mesh_.triangles[triangle][i]];
  }

  /// Builds the subtree of the triangles order_[begin, end) and returns its root.
  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Bounds bounds = empty_bounds();
    for (std::uint32_t n = begin; n < end; ++n)
      for (int i = 0; i < 3; ++i) {
        const Vec3 x = corner(order_[n], i);
        bounds = united_bounds(bounds, {x, x});
      }
    nodes_.push_back({bounds, begin, end, 0});
    if (end - begin <= leaf_size) return index;

    int axis;
    (bounds.max - bounds.min).maxCoeff(&axis);
    const auto center = [&](std::uint32_t t) {
      return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis];
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double ca = center(a), cb = center(b);
                       return ca != cb ? ca < cb : a < b;
                     });
    build(begin, middle);
    const std::uint32_t second = build(middle, end);
    nodes_[index].second = second;
    return index;
  }

  static double squared_distance(const Bounds& bounds, const Vec3& x) {
    return (x - x.cwiseMax(bounds.min).cwiseMin(bounds.max)).squaredNorm();
  }

  void improve(const Vec3& x, std::uint32_t triangle, Nearest& best) const {
    const auto [point, feature] =
        nearest_on_triangle(x, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
    const double squared = (x - point).squaredNorm();
    if (squared < best.squared_distance) best = {squared, point, triangle, feature};
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace snowshed::geometry
