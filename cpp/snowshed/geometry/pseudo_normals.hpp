// Normals of a closed mesh, which give the sign of its distance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "snowshed/geometry/triangle_hierarchy.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

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

  /// Returns the unit normal of a face.
  Vec3 face(std::uint32_t triangle) const {
    const auto& [a, b, c] = corners(triangle, 0);
    return (b - a).cross(c - a).normalized();
  }

  /// Returns the outward pseudo-normal of a feature of a triangle; it is not of unit length.
  Vec3 at(std::uint32_t triangle, Feature feature) const {
    const int f = static_cast<int>(feature);
    if (f < 3) return vertices_[mesh_.triangles[triangle][f]];
    if (f == 6) return face(triangle);
    const auto first =
        std::lower_bound(edges_.begin(), edges_.end(), std::make_pair(key(triangle, f - 3), 0u));
    return face(first->second) + face((first + 1)->second);
  }

 private:
  struct Corners {
    Vec3 a, b, c;
  };

  /// Returns the corners of a triangle in order, the i-th first.
  Corners corners(std::uint32_t triangle, int i) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {mesh_.vertices[t[i]], mesh_.vertices[t[(i + 1) % 3]], mesh_.vertices[t[(i + 2) % 3]]};
  }

  /// Returns a number that identifies the edge from corner i to the next. It is the same for both
  /// triangles that share the edge.
  std::uint64_t key(std::uint32_t triangle, int i) const {
    const Triangle& t = mesh_.triangles[triangle];
    const std::uint64_t a = t[i], b = t[(i + 1) % 3];
    return std::min(a, b) << 32 | std::max(a, b);
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3> vertices_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges_;  // sorted; two of each key
};

}  // namespace snowshed::geometry
