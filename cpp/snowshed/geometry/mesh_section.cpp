#include "snowshed/geometry/mesh_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <unordered_map>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"

namespace snowshed::geometry {
namespace {

/// Sides of the section's outline, with the solid on the left as seen along y.
struct Section {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 2>> sides;

  /// In the plane (x, z), m2.
  double area() const {
    if (points.empty()) return 0;
    const Vec3& origin = points.front();
    double twice = 0;
    for (const auto& [a, b] : sides) twice += (points[a] - origin).cross(points[b] - origin).y();
    return std::abs(twice) / 2;
  }
};

/// Cuts each triangle at y = `height`. Corners at that height count as below it, so that every
/// triangle is cut in two points or in none, and the outline is closed.
class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, double height) : mesh_(mesh), height_(height) {}

  Section cut() {
    for (const Triangle& t : mesh_.triangles) {
      // From the point where the triangle's border crosses downward to that where it crosses
      // upward.
      std::array<std::uint32_t, 2> side;
      int cuts = 0;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t from = t[i], to = t[(i + 1) % 3];
        if (is_above(from) == is_above(to)) continue;
        side[is_above(from) ? 0 : 1] = point_on(std::min(from, to), std::max(from, to));
        ++cuts;
      }
      if (cuts == 2) section_.sides.push_back(side);
    }
    return std::move(section_);
  }

 private:
  bool is_above(std::uint32_t vertex) const { return mesh_.vertices[vertex].y() > height_; }

  std::uint32_t point_on(std::uint32_t low, std::uint32_t high) {
    const auto [entry, is_new] =
        points_.try_emplace(std::uint64_t(low) << 32 | high, std::uint32_t(section_.points.size()));
    if (!is_new) return entry->second;
    const Vec3 &a = mesh_.vertices[low], &b = mesh_.vertices[high];
    Vec3 x = a + (height_ - a.y()) / (b.y() - a.y()) * (b - a);
    x.y() = 0;
    section_.points.push_back(x);
    return entry->second;
  }

  const TriangleMesh& mesh_;
  double height_;
  Section section_;
  std::unordered_map<std::uint64_t, std::uint32_t> points_;
};

/// Unites the ends of sides that are too short to have a direction.
void drop_short_sides(Section& section, double min_length) {
  std::vector<std::uint32_t> parent(section.points.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [a, b] : section.sides)
    if ((section.points[a] - section.points[b]).norm() <= min_length) parent[root(a)] = root(b);
  std::vector<std::array<std::uint32_t, 2>> sides;
  for (const auto& [a, b] : section.sides)
    if (root(a) != root(b)) sides.push_back({root(a), root(b)});
  section.sides = std::move(sides);
}

/// The surface that the outline sweeps along y.
TriangleMesh swept(const Section& section, double reach) {
  TriangleMesh mesh;
  for (const Vec3& p : section.points) {
    mesh.vertices.push_back(p - reach * Vec3::UnitY());
    mesh.vertices.push_back(p + reach * Vec3::UnitY());
  }
  for (const auto& [a, b] : section.sides) {
    mesh.triangles.push_back({2 * a, 2 * b, 2 * b + 1});
    mesh.triangles.push_back({2 * a, 2 * b + 1, 2 * a + 1});
  }
  return mesh;
}

std::vector<Section> cut_all(const std::vector<TriangleMesh>& meshes, double height) {
  std::vector<Section> sections;
  for (const TriangleMesh& mesh : meshes) sections.push_back(Cutter(mesh, height).cut());
  return sections;
}

double total_area(const std::vector<Section>& sections) {
  double sum = 0;
  for (const Section& section : sections) sum += section.area();
  return sum;
}

}  // namespace

std::vector<TriangleMesh> sections_at_y0(const std::vector<TriangleMesh>& meshes,
                                         const std::string& where) {
  Bounds bounds = empty_bounds();
  double nearest = infinity;  // distance from the vertices to the plane
  for (const TriangleMesh& mesh : meshes)
    for (const Vec3& v : mesh.vertices) {
      bounds = united_bounds(bounds, {v, v});
      nearest = std::min(nearest, std::abs(v.y()));
    }
  const double size = (bounds.max - bounds.min).norm(), plane_offset = 1e-6 * size;
  std::vector<Section> sections = cut_all(meshes, nearest > plane_offset ? 0.0 : plane_offset);
  if (nearest <= plane_offset) {
    std::vector<Section> before = cut_all(meshes, -plane_offset);
    if (total_area(before) > total_area(sections)) sections = std::move(before);
  }
  std::vector<TriangleMesh> surfaces;
  for (Section& section : sections) {
    drop_short_sides(section, 1e-12 * size);
    if (!section.sides.empty()) surfaces.push_back(swept(section, 50 * size));
  }
  if (surfaces.empty()) {
    std::ostringstream text;
    text << "the mesh lies between y = " << bounds.min.y() << " and " << bounds.max.y()
         << " m and does not meet the plane y = 0 of a two-dimensional scene; move it there, or "
            "use three dimensions";
    throw InputError(where, text.str());
  }
  return surfaces;
}

}  // namespace snowshed::geometry
