// Signed distance to a triangle mesh.
#pragma once

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed {

/// The solid inside `mesh`, which must satisfy require_solid. The nearest point is found with
/// a bounding volume hierarchy, the sign with angle-weighted pseudo-normals (Baerentzen &
/// Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal").
///
/// The inradius is that of the largest ball found that touches the surface from inside at the
/// centroid of one of up to 2000 triangles: a lower bound, and exact for solids of constant
/// thickness.
Shape make_mesh(TriangleMesh mesh);

}  // namespace snowshed
