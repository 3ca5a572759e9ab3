// The shells of a closed surface: its parts that are connected by edges.
#pragma once

#include <vector>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// Returns the shells of a mesh that satisfies require_closed, each with vertices of its own, in
/// the order of their first triangles. Every edge of a shell is shared by exactly two of its
/// triangles. Where more triangles meet at an edge, two of them are neighbours if the solid lies
/// between them.
std::vector<TriangleMesh> connected_shells(const TriangleMesh& mesh);

}  // namespace snowshed::geometry
