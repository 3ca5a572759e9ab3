// Triangles in place of the polygons of a mesh file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// A polygonal face by its corners, indices of vertices.
using Face = std::vector<std::uint32_t>;

/// Cuts the polygons of one file into triangles.
class FaceCutter {
 public:
  explicit FaceCutter(std::string where) : where_(std::move(where)) {}

  /// Appends the triangles of a face to the mesh, whose vertices it uses. They turn as the face
  /// does and use all of its corners. A convex face becomes a fan around the corner of the smallest
  /// coordinates, so that two faces that coincide are cut alike. Others are cut ear by ear
  /// (Meisters 1975) in the projection along the axis nearest to their normal, with exact
  /// orientations. Corners in the middle of an edge, outlines that touch themselves, and holes that
  /// a cut joins to the outline are therefore right.
  ///
  /// Throws InputError if the outline crosses itself, or if the concave faces of the file have so
  /// many corners that cutting them would take minutes.
  void append(const Face& face, TriangleMesh& mesh);

 private:
  std::string where_;
  std::size_t comparisons_ = 0;  // comparisons of corners with ears
};

}  // namespace snowshed::geometry
