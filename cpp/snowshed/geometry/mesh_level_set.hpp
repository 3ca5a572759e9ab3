// Signed distance to a triangle mesh.
#pragma once

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed {

/// The solid inside `mesh`, which must satisfy require_solid. The nearest point is found with
/// a bounding volume hierarchy, the sign with angle-weighted pseudo-normals (Baerentzen &
/// Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal").
///
/// The inradius is estimated: of the balls that touch the surface from inside at the centroids
/// of about 200 triangles the largest is moved to where it is locally deepest. A lower bound,
/// close for compact solids and exact for those of constant thickness.
Shape make_mesh(TriangleMesh mesh);

}  // namespace snowshed
