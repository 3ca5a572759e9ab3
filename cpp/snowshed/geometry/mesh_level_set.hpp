// Signed distance to a triangle mesh.
#pragma once

#include "snowshed/geometry/level_set.hpp"
#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// Returns the solid inside `mesh`, which must be closed and face outward (solid_of_shells),
/// or be swept by an outline (sections_at_y0). A bounding volume hierarchy
/// finds the nearest point; angle-weighted pseudo-normals give the sign (Baerentzen & Aanaes 2005,
/// "Signed distance computation using the angle weighted pseudonormal").
///
/// The inradius is a lower bound: close for compact solids, exact for those of constant thickness.
/// The estimate starts from the balls that touch the surface from inside at the centroids of about
/// 200 triangles. The largest of them is moved to where the depth has a local maximum.
Shape make_mesh(TriangleMesh mesh);

}  // namespace snowshed::geometry
