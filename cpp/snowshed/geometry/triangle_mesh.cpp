#include "snowshed/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include "snowshed/core/errors.hpp"

namespace snowshed::geometry {
namespace {

// Beyond this, products of coordinates lose their precision.
constexpr double max_coordinate = 1e9;  // m

struct DirectedEdge {
  std::uint32_t from, to;
  bool operator<(const DirectedEdge& o) const {
    return std::tie(from, to) < std::tie(o.from, o.to);
  }
  bool operator==(const DirectedEdge& o) const { return from == o.from && to == o.to; }
};

std::string describe(const Vec3& v) {
  std::ostringstream text;
  text << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")";
  return text.str();
}

/// Checks that triangles pass every edge as often in one direction as in the other; several solids
/// of a file may share an edge.
void check_closed(const TriangleMesh& mesh, const std::string& where) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());

  const auto fail = [&](const DirectedEdge& edge, const std::string& what) {
    throw InputError(where, "the edge from " + describe(mesh.vertices[edge.from]) + " to " +
                                describe(mesh.vertices[edge.to]) + " " + what);
  };
  for (auto first = edges.begin(); first != edges.end();) {
    const DirectedEdge edge = *first, back{edge.to, edge.from};
    if (edge.from == edge.to) fail(edge, "has no length");
    const auto end = std::upper_bound(first, edges.end(), edge);
    const auto backward = std::equal_range(edges.begin(), edges.end(), back);
    const auto uses = end - first, uses_back = backward.second - backward.first;
    if (uses > 1 && uses > uses_back)
      fail(edge, "is used " + (uses == 2 ? "twice" : std::to_string(uses) + " times") +
                     " in the same direction, and " + std::to_string(uses_back) +
                     " times in the other: neighbouring triangles must turn the same way");
    if (uses > uses_back) fail(edge, "belongs to one triangle only: the surface must be closed");
    first = end;
  }
}

}  // namespace

void require_valid_numbers(const TriangleMesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) throw InputError(where, "the mesh has no triangles");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!(mesh.vertices[v].cwiseAbs().maxCoeff() <= max_coordinate) ||
        !mesh.vertices[v].allFinite())
      throw InputError(where, "vertex " + std::to_string(v) + " " + describe(mesh.vertices[v]) +
                                  "; allowed: finite coordinates up to 1e9 m");
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      if (v >= mesh.vertices.size())
        throw InputError(where, "a triangle uses vertex " + std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
}

void merge_identical_vertices(TriangleMesh& mesh) {
  const std::vector<Vec3>& v = mesh.vertices;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(v[a].data(), v[a].data() + 3, v[b].data(), v[b].data() + 3);
  };
  std::vector<std::uint32_t> order(v.size()), merged(v.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);

  std::vector<Vec3> distinct;
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (n == 0 || before(order[n - 1], order[n])) distinct.push_back(v[order[n]]);
    merged[order[n]] = static_cast<std::uint32_t>(distinct.size() - 1);
  }
  mesh.vertices = std::move(distinct);

  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    const Triangle m = {merged[t[0]], merged[t[1]], merged[t[2]]};
    if (m[0] != m[1] && m[1] != m[2] && m[2] != m[0]) triangles.push_back(m);
  }
  mesh.triangles = std::move(triangles);
}

void cancel_opposite_triangles(TriangleMesh& mesh) {
  struct Facet {
    Triangle vertices;  // in ascending order
    bool turned;        // the order in the mesh is an odd permutation of the ascending order
    std::uint32_t number;
  };
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& given = mesh.triangles[t];
    Facet facet{given, false, t};
    std::rotate(facet.vertices.begin(),
                std::min_element(facet.vertices.begin(), facet.vertices.end()),
                facet.vertices.end());
    facet.turned = facet.vertices[1] > facet.vertices[2];
    if (facet.turned) std::swap(facet.vertices[1], facet.vertices[2]);
    facets.push_back(facet);
  }
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    return std::tie(a.vertices, a.turned, a.number) < std::tie(b.vertices, b.turned, b.number);
  });
  std::vector<char> dropped(mesh.triangles.size(), 0);
  for (auto first = facets.begin(); first != facets.end();) {
    const auto end = std::find_if(first, facets.end(),
                                  [&](const Facet& f) { return f.vertices != first->vertices; });
    auto back = std::find_if(first, end, [](const Facet& f) { return f.turned; });
    for (auto front = first, middle = back; front != middle && back != end; ++front, ++back)
      dropped[front->number] = dropped[back->number] = 1;
    first = end;
  }
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!dropped[t]) mesh.triangles[count++] = mesh.triangles[t];
  mesh.triangles.resize(count);
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Vec3 apex = mesh.vertices[mesh.triangles.front()[0]];  // a near one limits cancellation
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex,
               c = mesh.vertices[t[2]] - apex;
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

void require_closed(const TriangleMesh& mesh, const std::string& where) {
  require_valid_numbers(mesh, where);
  check_closed(mesh, where);
}

}  // namespace snowshed::geometry
