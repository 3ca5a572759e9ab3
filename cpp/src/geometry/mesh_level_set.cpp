#include "snowshed/geometry/mesh_level_set.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "snowshed/geometry/bounds.hpp"

namespace snowshed {
namespace {

/// The part of a triangle that is nearest to a point: one of its vertices, one of the edges
/// from vertex i to i + 1, or the face.
enum class Feature : std::uint8_t { vertex0, vertex1, vertex2, edge0, edge1, edge2, face };

struct Nearest {
  double squared_distance = infinity;
  Vec3 point = Vec3::Zero();
  std::uint32_t triangle = 0;
  Feature feature = Feature::face;
};

/// Nearest point of triangle abc to p, by the Voronoi region p lies in
/// (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
std::pair<Vec3, Feature> nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
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

/// Bounding volume hierarchy over the triangles, halved at the median: its depth is log2 n.
class Hierarchy {
 public:
  explicit Hierarchy(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, static_cast<std::uint32_t>(order_.size()));
  }

  Nearest nearest(const Vec3& x) const {
    Nearest best;
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
      std::uint32_t near = static_cast<std::uint32_t>(&node - nodes_.data()) + 1, far = node.second;
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

  /// The first child follows its parent; leaves have no second child and hold
  /// order_[begin, end).
  struct Node {
    Bounds bounds;
    std::uint32_t begin, end, second;
  };

  Vec3 corner(std::uint32_t triangle, int i) const {
    return mesh_.vertices[mesh_.triangles[triangle][i]];
  }

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Bounds bounds = no_bounds();
    for (std::uint32_t n = begin; n < end; ++n)
      for (int i = 0; i < 3; ++i) {
        const Vec3 x = corner(order_[n], i);
        bounds = unite(bounds, {x, x});
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

/// Face normals, and the angle-weighted pseudo-normals of vertices and edges.
class PseudoNormals {
 public:
  explicit PseudoNormals(const TriangleMesh& mesh)
      : mesh_(mesh), vertices_(mesh.vertices.size(), Vec3::Zero()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const auto& [a, b, c] = corners(t, i);
        const Vec3 u = b - a, v = c - a;
        vertices_[mesh.triangles[t][i]] += std::atan2(u.cross(v).norm(), u.dot(v)) * face(t);
        edges_.push_back({key(t, i), t});
      }
    std::sort(edges_.begin(), edges_.end());
  }

  Vec3 face(std::uint32_t triangle) const {
    const auto& [a, b, c] = corners(triangle, 0);
    return (b - a).cross(c - a).normalized();
  }

  /// Pointing outward; not of unit length.
  Vec3 at(std::uint32_t triangle, Feature feature) const {
    const int f = static_cast<int>(feature);
    if (f < 3) return vertices_[mesh_.triangles[triangle][f]];
    if (f == 6) return face(triangle);
    const auto first = std::lower_bound(edges_.begin(), edges_.end(),
                                        std::make_pair(key(triangle, f - 3), 0u));
    return face(first->second) + face((first + 1)->second);
  }

 private:
  struct Corners {
    Vec3 a, b, c;
  };

  /// The corners of a triangle in order, from the i-th on.
  Corners corners(std::uint32_t triangle, int i) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {mesh_.vertices[t[i]], mesh_.vertices[t[(i + 1) % 3]], mesh_.vertices[t[(i + 2) % 3]]};
  }

  /// The same for the two triangles that share the edge from corner i to the next.
  std::uint64_t key(std::uint32_t triangle, int i) const {
    const std::uint64_t a = mesh_.triangles[triangle][i], b = mesh_.triangles[triangle][(i + 1) % 3];
    return std::min(a, b) << 32 | std::max(a, b);
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3> vertices_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges_;  // sorted; two of each key
};

class Mesh final : public LevelSet {
 public:
  explicit Mesh(TriangleMesh mesh)
      : mesh_(std::move(mesh)), hierarchy_(mesh_), normals_(mesh_), inradius_(estimate_inradius()) {}

  double distance(const Vec3& x) const override {
    const Nearest n = hierarchy_.nearest(x);
    return std::copysign(std::sqrt(n.squared_distance), side(x, n));
  }

  Vec3 normal(const Vec3& x) const override {
    const Nearest n = hierarchy_.nearest(x);
    const Vec3 outward = x - n.point;
    const double length = outward.norm();
    // On the surface the direction to it is lost in rounding.
    const double lost = 1e-9 * (1 + x.cwiseAbs().maxCoeff());
    if (length > lost) return outward * std::copysign(1 / length, side(x, n));
    const Vec3 pseudo = normals_.at(n.triangle, n.feature);
    return pseudo.norm() > 0 ? Vec3(pseudo.normalized()) : Vec3::UnitZ();
  }

  Bounds bounds() const override { return hierarchy_.bounds(); }
  double inradius() const override { return inradius_; }

 private:
  double side(const Vec3& x, const Nearest& n) const {
    return (x - n.point).dot(normals_.at(n.triangle, n.feature));
  }

  double estimate_inradius() const {
    constexpr std::size_t samples = 2000;
    const std::size_t stride = std::max<std::size_t>(1, mesh_.triangles.size() / samples);
    double largest = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += stride)
      largest = std::max(largest, touching_ball(static_cast<std::uint32_t>(t)));
    return largest;
  }

  /// Radius of the largest ball inside that touches the triangle at its centroid (Ma, Bae &
  /// Choi 2012, "3D medial axis point approximation using nearest neighbors"): a ball that
  /// holds another point of the surface is shrunk until that point is on it.
  double touching_ball(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    const Vec3 touch =
        (mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]]) / 3;
    const Vec3 inward = -normals_.face(triangle);
    if (inward.isZero(0.0)) return 0;
    double radius = (bounds().max - bounds().min).norm();
    for (int step = 0; step < 30; ++step) {
      const Nearest n = hierarchy_.nearest(touch + radius * inward);
      if (std::sqrt(n.squared_distance) > radius * (1 - 1e-6)) break;
      const Vec3 chord = n.point - touch;
      const double depth = chord.dot(inward);
      if (!(depth > 0)) return 0;
      radius = chord.squaredNorm() / (2 * depth);
    }
    return std::max(0.0, -distance(touch + radius * inward));
  }

  const TriangleMesh mesh_;
  const Hierarchy hierarchy_;
  const PseudoNormals normals_;
  const double inradius_;
};

}  // namespace

Shape make_mesh(TriangleMesh mesh) { return std::make_shared<Mesh>(std::move(mesh)); }

}  // namespace snowshed
