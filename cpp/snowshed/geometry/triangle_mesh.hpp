// A closed surface of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry {

using Triangle = std::array<std::uint32_t, 3>;

/// Vertices in metres. The vertices of a triangle run counter-clockwise as seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Throws InputError at `where` (a file or JSON path) unless the mesh has triangles, its
/// coordinates are finite and at most 1e9 m, and all vertices that its triangles use exist.
void require_valid_numbers(const TriangleMesh& mesh, const std::string& where);

/// Merges vertices with identical coordinates and drops the triangles that this collapses. STL
/// repeats vertices for every triangle, other formats at seams. The mesh must have valid numbers.
void merge_identical_vertices(TriangleMesh& mesh);

/// Removes pairs of triangles that have the same vertices and turn opposite ways, as where two
/// solids share a face, or where a cut joins a hole to an outline. They bound nothing.
void cancel_opposite_triangles(TriangleMesh& mesh);

/// Returns the volume enclosed by a closed mesh, m3; negative if the triangles face inward.
double enclosed_volume(const TriangleMesh& mesh);

/// Throws InputError at `where` unless the mesh is a closed surface: its numbers are valid, and its
/// triangles run through every edge as often in one direction as in the other.
void require_closed(const TriangleMesh& mesh, const std::string& where);

}  // namespace snowshed::geometry
