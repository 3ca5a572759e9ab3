#include "snowshed/geometry/connected_shells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "snowshed/core/angles.hpp"

namespace snowshed::geometry {
namespace {

/// Sets of numbers that are merged pair by pair.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  /// Merges the sets of a and b; the smaller root stays the root.
  void merge(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parents_;
};

/// The use of an edge by a triangle, from its corner `corner` to the next.
struct EdgeUse {
  std::uint32_t low, high;  // vertices
  std::uint32_t triangle;
  std::uint8_t corner;
  bool upward;  // from `low` to `high`

  bool same_edge(const EdgeUse& o) const { return low == o.low && high == o.high; }
};

std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint8_t i = 0; i < 3; ++i) {
      const std::uint32_t from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), t, i, from < to});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) <
           std::tie(b.low, b.high, b.triangle, b.corner);
  });
  return uses;
}

/// The uses of an edge in the order of the angles of their triangles around it.
std::vector<EdgeUse> around_edge(const TriangleMesh& mesh, const EdgeUse* first,
                                 const EdgeUse* end) {
  const Vec3& foot = mesh.vertices[first->low];
  const Vec3 axis = (mesh.vertices[first->high] - foot).normalized();
  const auto direction_to_apex = [&](const EdgeUse& use) {
    const Vec3 r = mesh.vertices[mesh.triangles[use.triangle][(use.corner + 2) % 3]] - foot;
    return Vec3(r - r.dot(axis) * axis);
  };
  const Vec3 x = direction_to_apex(*first).normalized(), y = axis.cross(x);
  constexpr double angle_tolerance = 1e-9;  // rad; faces that coincide
  std::vector<std::pair<double, EdgeUse>> uses;
  for (const EdgeUse* use = first; use != end; ++use) {
    const Vec3 r = direction_to_apex(*use);
    double angle = std::atan2(r.dot(y), r.dot(x));
    if (angle < -angle_tolerance) angle += 2 * pi;
    uses.emplace_back(angle, *use);
  }
  std::stable_sort(uses.begin(), uses.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  // Among coincident faces, those that end a solid come before those that begin the next.
  for (auto begin = uses.begin(); begin != uses.end();) {
    auto last = begin + 1;
    while (last != uses.end() && last->first - (last - 1)->first < angle_tolerance) ++last;
    std::stable_partition(begin, last, [](const auto& use) { return use.second.upward; });
    begin = last;
  }
  std::vector<EdgeUse> ordered;
  for (const auto& [angle, use] : uses) ordered.push_back(use);
  return ordered;
}

/// Calls pair(use, use) for the triangles that are neighbours at an edge. With growing angle, the
/// solid begins at a triangle that traverses the edge downward and ends at one that traverses it
/// upward. The triangles therefore match like parentheses.
template <class Pair>
void pair_neighbours(const TriangleMesh& mesh, const EdgeUse* first, const EdgeUse* end,
                     Pair pair) {
  if (end - first == 2) return pair(first[0], first[1]);
  std::vector<EdgeUse> uses = around_edge(mesh, first, end);
  std::ptrdiff_t depth = 0, min_depth = 0, first_use = 0;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    depth += uses[i].upward ? -1 : 1;
    if (depth >= min_depth) continue;
    min_depth = depth;
    first_use = std::ptrdiff_t(i) + 1;
  }
  std::rotate(uses.begin(), uses.begin() + first_use, uses.end());
  std::vector<EdgeUse> open_uses;
  for (const EdgeUse& use : uses) {
    if (!use.upward) {
      open_uses.push_back(use);
      continue;
    }
    pair(open_uses.back(), use);
    open_uses.pop_back();
  }
}

/// Sets of triangle corners that form a vertex, and of triangles that form a shell.
struct Connections {
  DisjointSets corners, triangles;
};

Connections connect(const TriangleMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  Connections connections{DisjointSets(3 * n), DisjointSets(n)};
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  const auto corner = [](const EdgeUse& use, int i) {
    return 3 * use.triangle + std::uint32_t((use.corner + i) % 3);
  };
  for (const EdgeUse *first = uses.data(), *last = first + uses.size(); first != last;) {
    const EdgeUse* end = first + 1;
    while (end != last && end->same_edge(*first)) ++end;
    pair_neighbours(mesh, first, end, [&](const EdgeUse& a, const EdgeUse& b) {
      connections.corners.merge(corner(a, 0), corner(b, 1));
      connections.corners.merge(corner(a, 1), corner(b, 0));
      connections.triangles.merge(a.triangle, b.triangle);
    });
    first = end;
  }
  return connections;
}

}  // namespace

std::vector<TriangleMesh> connected_shells(const TriangleMesh& mesh) {
  constexpr std::uint32_t none = UINT32_MAX;
  Connections connections = connect(mesh);
  std::vector<TriangleMesh> shells;
  std::vector<std::uint32_t> shell_of(mesh.triangles.size(), none);
  std::vector<std::uint32_t> vertex_of(3 * mesh.triangles.size(), none);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::uint32_t& number = shell_of[connections.triangles.root(t)];
    if (number == none) {
      number = std::uint32_t(shells.size());
      shells.emplace_back();
    }
    TriangleMesh& shell = shells[number];
    Triangle triangle;
    for (std::uint32_t i = 0; i < 3; ++i) {
      std::uint32_t& vertex = vertex_of[connections.corners.root(3 * t + i)];
      if (vertex == none) {
        vertex = std::uint32_t(shell.vertices.size());
        shell.vertices.push_back(mesh.vertices[mesh.triangles[t][i]]);
      }
      triangle[i] = vertex;
    }
    shell.triangles.push_back(triangle);
  }
  return shells;
}

}  // namespace snowshed::geometry
