// The solid that a closed surface of several shells bounds.
#pragma once

#include <string>
#include <vector>

#include "snowshed/geometry/triangle_mesh.hpp"

namespace snowshed::geometry {

/// A solid as the union of meshes, whose triangles face outward.
struct ShellSolid {
  std::vector<TriangleMesh> layers;  // separate shells, each with its cavities
  std::vector<std::string> notes;    // on changes, a sentence each
};

/// Returns the solid bounded by `mesh`, which must satisfy require_closed.
///
/// A shell is a part of the surface that is connected by edges. Where more than two triangles share
/// an edge, two of them are neighbours if the solid lies between them. Solids that touch along an
/// edge or a face are therefore separate shells.
///
/// - A shell that lies in no other shell faces outward, even if the file turns it inward.
/// - Shells within others follow the rule of non-zero winding. If a shell is turned opposite to the
///   shell around it, it is a cavity, and a shell in a cavity is solid again. If both are turned
///   the same way, the inner shell lies in the solid and bounds nothing.
/// - Shells that overlap are united.
/// - Shells without volume, such as sheets with two faces, are left out.
///
/// Throws InputError at `where` if no shell has a volume, if a surface runs through itself, or if
/// there are more than 10000 shells.
ShellSolid solid_of_shells(const TriangleMesh& mesh, const std::string& where);

/// Returns all triangles of a solid's layers as one mesh.
TriangleMesh merged_layers(const ShellSolid& solid);

}  // namespace snowshed::geometry
