// The cross-section of a mesh with the plane of two-dimensional scenes, y = 0.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// Returns, for each mesh of a solid, the surface that its cross-section sweeps along y, far beyond
/// the mesh. On the plane y = 0 the distance to it is the distance to the outline of the section.
/// Meshes that do not meet the plane give none.
///
/// Where faces, edges or corners lie in the plane, or nearer to it than a millionth of the solid's
/// size, the section is taken just beside them, on the side where it is larger. A solid that ends
/// at the plane is thus as large in two dimensions as just inside its end.
///
/// Throws InputError at `where` if no mesh meets the plane; the message gives the solid's extent
/// along y.
std::vector<TriangleMesh> sections_at_y0(const std::vector<TriangleMesh>& meshes,
                                         const std::string& where);

}  // namespace snowshed::geometry
