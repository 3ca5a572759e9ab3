// Meshes shared by tests.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry_testing {

inline geometry::TriangleMesh box_mesh(const Vec3& min, const Vec3& max) {
  geometry::TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back((corner & 1 ? max : min).x(), (corner & 2 ? max : min).y(),
                               (corner & 4 ? max : min).z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Returns a ball of `rings` x 2 `rings` facets whose vertices lie on the sphere.
inline geometry::TriangleMesh sphere_mesh(double radius, std::uint32_t rings) {
  geometry::TriangleMesh mesh;
  const std::uint32_t sides = 2 * rings;
  mesh.vertices = {{0, 0, -radius}, {0, 0, radius}};
  for (std::uint32_t i = 1; i < rings; ++i)
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double latitude = pi * (double(i) / rings - 0.5), longitude = 2 * pi * j / sides;
      mesh.vertices.push_back(radius * Vec3(std::cos(latitude) * std::cos(longitude),
                                            std::cos(latitude) * std::sin(longitude),
                                            std::sin(latitude)));
    }
  const auto at = [&](std::uint32_t ring, std::uint32_t side) {
    return 2 + ring * sides + side % sides;
  };
  for (std::uint32_t j = 0; j < sides; ++j) {
    mesh.triangles.push_back({0, at(0, j + 1), at(0, j)});
    mesh.triangles.push_back({1, at(rings - 2, j), at(rings - 2, j + 1)});
    for (std::uint32_t i = 0; i + 2 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

}  // namespace snowshed::geometry_testing
