#include "snowshed/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

// Beyond this, products of coordinates lose their precision.
constexpr double largest_coordinate = 1e9;  // m

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
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].from == edges[e].to) fail(edges[e], "has no length");
    if (e > 0 && edges[e] == edges[e - 1])
      fail(edges[e],
           "is used twice in the same direction: neighbouring triangles must turn the "
           "same way, and no more than two may share an edge");
  }
  for (const DirectedEdge& edge : edges)
    if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{edge.to, edge.from}))
      fail(edge, "belongs to one triangle only: the surface must be closed");
}

}  // namespace

void require_valid_numbers(const TriangleMesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) throw InputError(where, "the mesh has no triangles");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!(mesh.vertices[v].cwiseAbs().maxCoeff() <= largest_coordinate) ||
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

  std::vector<Vec3> kept;
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (n == 0 || before(order[n - 1], order[n])) kept.push_back(v[order[n]]);
    merged[order[n]] = static_cast<std::uint32_t>(kept.size() - 1);
  }
  mesh.vertices = std::move(kept);

  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    const Triangle m = {merged[t[0]], merged[t[1]], merged[t[2]]};
    if (m[0] != m[1] && m[1] != m[2] && m[2] != m[0]) triangles.push_back(m);
  }
  mesh.triangles = std::move(triangles);
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

void require_solid(TriangleMesh& mesh, const std::string& where) {
  require_valid_numbers(mesh, where);
  check_closed(mesh, where);
  Vec3 low = mesh.vertices[mesh.triangles.front()[0]], high = low;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  const double volume = enclosed_volume(mesh), size = (high - low).norm();
  if (!(std::abs(volume) > 1e-12 * size * size * size))
    throw InputError(where, "the mesh encloses no volume");
  if (volume < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace snowshed
