#include "snowshed/geometry/readers/mesh_io.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <sstream>

#include "geometry/mesh_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

TriangleMesh sample() { return box_mesh({0, 0, 0}, {1, 2, 3}); }

template <class Number>
std::string bytes_of(Number number, bool big = false) {
  std::string raw(sizeof(Number), '\0');
  std::memcpy(raw.data(), &number, sizeof(Number));
  if (big) std::reverse(raw.begin(), raw.end());
  return raw;
}

std::string binary_stl(const TriangleMesh& mesh, const std::string& title = "made by hand") {
  std::string out = title + std::string(80 - title.size(), ' ');
  out += bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    out += std::string(12, '\0');
    for (const auto v : t)
      for (const double c : mesh.vertices[v]) out += bytes_of(static_cast<float>(c));
    out += std::string(2, '\0');
  }
  return out;
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "solid cube\n";
  for (const Triangle& t : mesh.triangles) {
    out << " facet normal 0 0 0\n  outer loop\n";
    for (const auto v : t) out << "   vertex " << mesh.vertices[v].transpose() << "\r\n";
    out << "  endloop\n endfacet\n";
  }
  out << "endsolid cube\n";
  return out.str();
}

std::string obj(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "# a cube\nmtllib none.mtl\n";
  for (const Vec3& v : mesh.vertices) out << "v " << v.transpose() << "\n";
  out << "vn 0 0 1\nvt 0 0\n";
  const char* const tails[] = {"/1/1", "//1", ""};
  const int count = static_cast<int>(mesh.vertices.size());
  int n = 0;
  for (const Triangle& t : mesh.triangles) {
    out << "f";
    for (const auto v : t) out << " " << (n % 2 ? int(v) + 1 : int(v) - count) << tails[n % 3];
    out << "\n";
    ++n;
  }
  return out.str();
}

std::string ply_header(const std::string& format, const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "ply\nformat " << format << " 1.0\ncomment x\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n"
      << "element face " << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\n"
      << "end_header\n";
  return out.str();
}

std::string ascii_ply(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << ply_header("ascii", mesh);
  for (const Vec3& v : mesh.vertices) out << v.transpose() << " 255\n";
  for (const Triangle& t : mesh.triangles)
    out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

std::string binary_ply(const TriangleMesh& mesh, bool big) {
  std::string out = ply_header(big ? "binary_big_endian" : "binary_little_endian", mesh);
  for (const Vec3& v : mesh.vertices) {
    out += bytes_of(float(v.x()), big) + bytes_of(v.y(), big) + bytes_of(float(v.z()), big);
    out += '\xff';
  }
  for (const Triangle& t : mesh.triangles) {
    out += '\x03';
    for (const auto v : t) out += bytes_of(static_cast<std::int32_t>(v), big);
  }
  return out;
}

class MeshIo : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& name, const std::string& content, double scale = 1) {
    return read_mesh(dir.write(name, content), scale);
  }
  void expect_refused(const std::string& name, const std::string& content,
                      const std::string& expected) {
    expect_input_error([&] { read(name, content); }, expected);
    expect_input_error([&] { read(name, content); }, name);
  }
  void expect_sample(const TriangleMesh& mesh) {
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NEAR(enclosed_volume(mesh), 6, 1e-9);
  }
  TempDir dir;
};

TEST_F(MeshIo, ReadsEveryFormat) {
  expect_sample(read("a.stl", binary_stl(sample())));
  expect_sample(read("b.STL", binary_stl(sample(), "solid but binary")));
  expect_sample(read("c.stl", ascii_stl(sample())));
  expect_sample(read("d.obj", obj(sample())));
  expect_sample(read("e.ply", ascii_ply(sample())));
  expect_sample(read("f.ply", binary_ply(sample(), false)));
  expect_sample(read("g.ply", binary_ply(sample(), true)));
}

TEST_F(MeshIo, ScalesToMetres) {
  EXPECT_NEAR(enclosed_volume(read("a.stl", ascii_stl(sample()), 1e-3)), 6e-9, 1e-18);
}

TEST_F(MeshIo, QuadsBecomeTwoTriangles) {
  const std::string quads =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
      "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const TriangleMesh mesh = read("a.obj", quads);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

// A trough whose ends are polygons of eight corners, and a plate with a hole that a cut joins to
// its outline, as OBJ and as PLY. Each polygon is tried from each of its corners.
TEST_F(MeshIo, ConcavePolygonsAreTriangulated) {
  struct Case {
    std::vector<std::array<double, 2>> outline;
    double area;
  };
  const Case cases[] = {
      {{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 5},
      {{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}, 12}};
  for (const Case& c : cases)
    for (std::size_t start = 0; start < c.outline.size(); ++start) {
      const std::size_t n = c.outline.size();
      std::ostringstream obj, ply_vertices, ply_faces;
      for (const double y : {0.0, 1.0})
        for (std::size_t i = 0; i < n; ++i) {
          const auto& [x, z] = c.outline[(i + start) % n];
          obj << "v " << x << " " << y << " " << z << "\n";
          ply_vertices << x << " " << y << " " << z << "\n";
        }
      std::vector<std::vector<std::size_t>> faces(2);
      for (std::size_t i = 0; i < n; ++i) {
        faces[0].push_back(i);
        faces[1].push_back(2 * n - 1 - i);
        faces.push_back({(i + 1) % n, i, n + i, n + (i + 1) % n});
      }
      for (const auto& face : faces) {
        obj << "f";
        ply_faces << face.size();
        for (const std::size_t v : face) {
          obj << " " << v + 1;
          ply_faces << " " << v;
        }
        obj << "\n";
        ply_faces << "\n";
      }
      std::ostringstream header;
      header << "ply\nformat ascii 1.0\nelement vertex " << 2 * n
             << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
             << faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
      for (const TriangleMesh& mesh :
           {read("a.obj", obj.str()),
            read("a.ply", header.str() + ply_vertices.str() + ply_faces.str())}) {
        ASSERT_NEAR(enclosed_volume(mesh), c.area, 1e-12) << start;
        double surface = 0;  // too large if there are additional walls
        for (const Triangle& t : mesh.triangles) {
          const Vec3& a = mesh.vertices[t[0]];
          surface += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 2;
        }
        ASSERT_NEAR(surface, 2 * c.area + (c.area == 5 ? 12 : 24), 1e-12) << start;
      }
    }
}

TEST_F(MeshIo, RefusesMissingFilesAndOtherTypes) {
  expect_input_error([&] { read_mesh(dir.path() / "none.stl"); }, "no such file");
  std::filesystem::create_directories(dir.path() / "folder.stl");
  expect_input_error([&] { read_mesh(dir.path() / "folder.stl"); }, "regular file");
  expect_refused("a.step", "x", ".stl, .obj, .ply");
}

TEST_F(MeshIo, RefusesBrokenStl) {
  const std::string good = binary_stl(sample());
  expect_refused("a.stl", "", "too short");
  expect_refused("b.stl", good.substr(0, good.size() - 1), "12 triangles declared");
  std::string huge = good;
  huge.replace(80, 4, "\xff\xff\xff\xff");
  expect_refused("c.stl", huge, "4294967295 triangles declared");
  std::string nan = good;
  nan.replace(84 + 12, 4, bytes_of(std::nanf("")));
  expect_refused("d.stl", nan, "finite");
  std::string text = ascii_stl(sample());
  expect_refused("e.stl", text.substr(0, text.size() / 2), "stl:");
  expect_refused("f.stl", text + "garbage\n", "garbage");
  expect_refused("g.stl", "solid\nfacet\nouter loop\nvertex 0 0 nan\n", "g.stl:4: 'nan'");
  expect_refused("h.stl", "solid\nfacet\nouter loop\nvertex 0 0\n", "h.stl:4: too few");
  expect_refused("i.stl", "solid\nendsolid\n", "no triangles");
}

TEST_F(MeshIo, RefusesBrokenObj) {
  const std::string good = obj(sample());
  expect_refused("a.obj", "", "no triangles");
  expect_refused("b.obj", good.substr(0, good.rfind("f")), "closed");
  expect_refused("c.obj", "v 0 0 0\nf 1 2 3\n", "c.obj:2: vertex 2");
  expect_refused("d.obj", "v 0 0 0\nf 0 1 1\n", "vertex 0");
  expect_refused("e.obj", "v 0 0 0\nf -2 1 1\n", "vertex -2");
  expect_refused("f.obj", "v 0 \xe9\x1b[2J 0\n", "'??[2J' is not a valid number");
  expect_refused("f.obj", "v 0 0 1e999\n", "f.obj:1: '1e999'");
  expect_refused("g.obj", "v 0 0 0\nf 1 1\n", "fewer than three");
  expect_refused("h.obj", "f 99999999999999999999 1 1\n", "h.obj:1");
}

TEST_F(MeshIo, RefusesBrokenPly) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string text = ascii_ply(sample()), binary = binary_ply(sample(), false);
  expect_refused("a.ply", "", "not a PLY file");
  expect_refused("b.ply", "ply\nformat ascii 1.0\n", "end_header");
  expect_refused("c.ply", with(text, "vertex 8", "vertex 99999999999"), "99999999999");
  expect_refused("d.ply", with(binary, "face 12", "face 18446744073709551615"), "face");
  expect_refused("e.ply", with(binary, "face 12", "face 13"), "ends in the middle");
  expect_refused("f.ply", with(text, "face 12", "face 13"), "ends before");
  expect_refused("g.ply", with(text, "ascii", "morse"), "morse");
  expect_refused("h.ply", with(text, "list uchar int", "list uchar soup"), "property list");
  expect_refused("i.ply", with(text, "3 0 2 1", "3 0 2 8"), "whole number below 8");
  expect_refused("j.ply", with(text, "3 0 2 1", "3 0 2 1 7"), "more values");
  expect_refused("k.ply", with(text, "3 0 2 1", "-1 0 2 1"), "length of a list");
  expect_refused("l.ply", with(text, "3 0 2 1", "3 0 2"), "too few");
  expect_refused("m.ply", binary.substr(0, binary.size() - 3), "byte");
  expect_refused("n.ply", "ply\nformat ascii 1.0\nelement nothing 3\nend_header\n1\n2\n",
                 "nothing");
}

// Reading a damaged file must give a mesh or an InputError.
TEST_F(MeshIo, SurvivesDamage) {
  const TriangleMesh mesh = sphere_mesh(1, 4);
  const std::pair<const char*, std::string> files[] = {{"a.stl", binary_stl(mesh)},
                                                       {"b.stl", ascii_stl(mesh)},
                                                       {"c.obj", obj(mesh)},
                                                       {"d.ply", ascii_ply(mesh)},
                                                       {"e.ply", binary_ply(mesh, true)}};
  Random random(15);
  int refused = 0;
  for (const auto& [name, content] : files)
    for (int n = 0; n < 200; ++n) {
      std::string damaged = content;
      for (int change = 0; change < 3; ++change)
        damaged[random.next() % damaged.size()] = static_cast<char>(random.next());
      if (n % 2) damaged.resize(random.next() % damaged.size());
      try {
        read(name, damaged);
      } catch (const InputError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace snowshed::geometry
