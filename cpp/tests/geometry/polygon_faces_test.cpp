#include "snowshed/geometry/polygon_faces.hpp"

#include <numeric>

#include "geometry/mesh_testing.hpp"
#include "snowshed/geometry/orientation.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

TEST(Orientation, IsExact) {
  EXPECT_GT(orientation({0, 0}, {1, 0}, {0, 1}), 0);
  EXPECT_LT(orientation({0, 0}, {0, 1}, {1, 0}), 0);
  // Points along a diagonal; one is moved by the last bit of a coordinate.
  const double tiny = std::nextafter(0.5, 1) - 0.5;
  EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
  EXPECT_GT(orientation({0.5, 0.5 + tiny}, {12, 12}, {24, 24}), 0);
  EXPECT_LT(orientation({0.5 + tiny, 0.5}, {12, 12}, {24, 24}), 0);
}

/// A polygon of the plane (x, z), counter-clockwise as seen from -y, and its area.
struct Outline2 {
  const char* name;
  std::vector<std::array<double, 2>> points;
  double area;
};

std::vector<Outline2> outlines() {
  std::vector<Outline2> all = {
      {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1},
      {"square with corners in its edges",
       {{0, 0}, {0.5, 0}, {1, 0}, {1, 0.3}, {1, 0.7}, {1, 1}, {0, 1}, {0, 0.5}},
       1},
      {"trough", {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 5},
      {"trough with corners in its edges",
       {{0, 0}, {1.5, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1.5, 1}, {1, 1}, {1, 2}, {0, 2}},
       5},
      {"spiral",
       {{0, 0},
        {5, 0},
        {5, 5},
        {1, 5},
        {1, 2},
        {3, 2},
        {3, 3},
        {2, 3},
        {2, 4},
        {4, 4},
        {4, 1},
        {0, 1}},
       // a band of width 1: 5 + 4 + 3 + 2 + 1 + ... counted cell by cell
       5 + 4 + 3 + 2 + 1},
      {"dart", {{0, 0}, {2, 1}, {0, 2}, {1, 1}}, 1},
      {"square with a hole that a cut joins to the outline",
       {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},
       12},
      {"two squares that touch in a corner",
       {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}},
       2},
      {"square with a spike of no width", {{0, 0}, {1, 0}, {1, 1}, {3, 1}, {1, 1}, {0, 1}}, 1}};
  Outline2 comb{"comb", {}, 0};
  const int teeth = 50;
  for (int k = 0; k < teeth; ++k)
    for (const auto& [x, z] : {Point2{0, 0}, {0.5, 0}, {0.5, -1}, {1, -1}})
      comb.points.push_back({k + x, z});
  comb.points.push_back({double(teeth), 1});
  comb.points.push_back({0, 1});
  comb.area = teeth + teeth / 2.0;
  all.push_back(comb);
  return all;
}

Vec3 area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2;
}

TEST(PolygonFaces, TrianglesCoverTheFaceOnce) {
  for (const Outline2& outline : outlines())
    for (std::size_t start = 0; start < std::min<std::size_t>(12, outline.points.size()); ++start)
      for (const bool back : {false, true})
        for (const double turn : {0.0, 2.2}) {
          const Mat3 rotation =
              Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized()).toRotationMatrix();
          TriangleMesh mesh;
          for (const auto& [x, z] : outline.points)
            mesh.vertices.push_back(rotation * Vec3(x, 0, z));
          Face face(outline.points.size());
          for (std::size_t i = 0; i < face.size(); ++i)
            face[i] = std::uint32_t((start + (back ? face.size() - i : i)) % face.size());
          FaceCutter("m").append(face, mesh);
          double area = 0, sum = 0;
          for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            area += area_of(mesh, t).dot(rotation.col(1));
            sum += area_of(mesh, t).norm();
          }
          const double expected = back ? outline.area : -outline.area;
          ASSERT_NEAR(area, expected, 1e-9 * outline.area) << outline.name << " from " << start;
          ASSERT_NEAR(sum, outline.area, 1e-9 * outline.area) << outline.name << " from " << start;
        }
}

/// Prism over an outline; its ends are polygons, its sides quads.
TriangleMesh prism(const Outline2& outline, std::size_t start) {
  TriangleMesh mesh;
  const auto n = std::uint32_t(outline.points.size());
  for (const double y : {0.0, 1.0})
    for (const auto& [x, z] : outline.points) mesh.vertices.emplace_back(x, y, z);
  FaceCutter cutter("m");
  Face front, back;
  for (std::uint32_t i = 0; i < n; ++i) {
    front.push_back((i + std::uint32_t(start)) % n);
    back.push_back(n + (2 * n - i - std::uint32_t(start)) % n);
  }
  cutter.append(front, mesh);
  cutter.append(back, mesh);
  for (std::uint32_t i = 0; i < n; ++i)
    cutter.append({(i + 1) % n, i, n + i, n + (i + 1) % n}, mesh);
  return mesh;
}

TEST(PolygonFaces, PrismsAreClosed) {
  for (const Outline2& outline : outlines()) {
    if (std::string(outline.name).find("touch") != std::string::npos) continue;
    for (std::size_t start = 0; start < std::min<std::size_t>(12, outline.points.size()); ++start) {
      TriangleMesh mesh = prism(outline, start);
      merge_identical_vertices(mesh);
      require_closed(mesh, outline.name);
      ASSERT_NEAR(std::abs(enclosed_volume(mesh)), outline.area, 1e-9 * outline.area)
          << outline.name << " from " << start;
    }
  }
}

TEST(PolygonFaces, RefusesOutlinesThatCrossThemselves) {
  TriangleMesh star;
  Face face(5);
  std::iota(face.begin(), face.end(), 0u);
  for (int k = 0; k < 5; ++k)
    star.vertices.emplace_back(std::cos(0.8 * pi * k), std::sin(0.8 * pi * k), 0);
  expect_input_error([&] { FaceCutter("a.obj").append(face, star); }, "crosses itself");
}

// The comparisons per file are limited, so that a hostile file cannot take minutes.
TEST(PolygonFaces, RefusesTooManyCornersOfConcaveFaces) {
  TriangleMesh mesh;
  Face face;
  for (int k = 0; k < 20000; ++k) {
    face.push_back(std::uint32_t(mesh.vertices.size()));
    mesh.vertices.emplace_back(k, 0, k % 2 ? 1.0 + 1e-9 * k * k : -1e-9 * k * k);
  }
  face.push_back(std::uint32_t(mesh.vertices.size()));
  mesh.vertices.emplace_back(10000, 0, 1e6);
  const auto cut = [&] {
    FaceCutter cutter("a.ply");
    for (int n = 0; n < 20; ++n) cutter.append(face, mesh);
  };
  expect_input_error(cut, "too many");
}

}  // namespace
}  // namespace snowshed::geometry
