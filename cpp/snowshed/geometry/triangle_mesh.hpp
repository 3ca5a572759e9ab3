// A closed surface of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed {

using Triangle = std::array<std::uint32_t, 3>;

/// Vertices in metres; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Throws InputError at `where` (a file or JSON path) unless there are triangles, coordinates
/// are finite and at most 1e9 m, and all vertices that triangles use exist.
void require_valid_numbers(const TriangleMesh& mesh, const std::string& where);

/// Makes one vertex of those with identical coordinates (STL repeats them for every triangle,
/// other formats at seams) and drops the triangles this collapses. The mesh
/// must have valid numbers.
void merge_identical_vertices(TriangleMesh& mesh);

/// Volume enclosed by a closed mesh, m3; negative if the triangles face inward.
double enclosed_volume(const TriangleMesh& mesh);

/// Makes sure that the mesh bounds a solid: valid numbers, every edge shared by exactly two
/// triangles that run through it in opposite directions, a volume that is not zero. Turns the
/// triangles outward if they face inward. Throws InputError at `where` otherwise.
void require_solid(TriangleMesh& mesh, const std::string& where);

}  // namespace snowshed
