#include "snowshed/geometry/mesh_shells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/connected_shells.hpp"
#include "snowshed/geometry/mesh_level_set.hpp"

namespace snowshed::geometry {
namespace {

constexpr std::size_t max_shells = 10'000;

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds bounds = empty_bounds();
  for (const Vec3& v : mesh.vertices) bounds = united_bounds(bounds, {v, v});
  return bounds;
}

double size_of(const Bounds& bounds) { return (bounds.max - bounds.min).norm(); }

bool holds(const Bounds& outer, const Bounds& inner) {
  return (outer.min.array() <= inner.min.array()).all() &&
         (outer.max.array() >= inner.max.array()).all();
}

bool touch(const Bounds& a, const Bounds& b) {
  const double margin = 1e-9 * std::max(size_of(a), size_of(b));
  return (a.min.array() <= b.max.array() + margin).all() &&
         (b.min.array() <= a.max.array() + margin).all();
}

void turn(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// A shell that faces outward, and its relation to the others.
struct Shell {
  TriangleMesh mesh;
  Bounds bounds;
  double volume;                        // m3
  int sense;                            // sense in the file: 1 outward, -1 inward
  std::vector<std::size_t> containers;  // shells around it, from the smallest to the largest
  Shape solid;                          // made when the shell may contain others
};

/// Orders the shells by volume, and omits those without volume.
std::vector<Shell> with_volumes(std::vector<TriangleMesh> meshes) {
  std::vector<Shell> shells;
  for (TriangleMesh& mesh : meshes) {
    const Bounds bounds = bounds_of(mesh);
    const double volume = enclosed_volume(mesh), size = size_of(bounds);
    if (!(std::abs(volume) > 1e-12 * size * size * size)) continue;
    if (volume < 0) turn(mesh);
    shells.push_back({std::move(mesh), bounds, std::abs(volume), volume < 0 ? -1 : 1, {}, {}});
  }
  std::stable_sort(shells.begin(), shells.end(),
                   [](const Shell& a, const Shell& b) { return a.volume < b.volume; });
  return shells;
}

/// Whether `inner`, which does not cross the surface of `outer`, lies within it.
bool is_within(const Shell& inner, Shell& outer) {
  constexpr std::size_t samples = 16;
  if (!holds(outer.bounds, inner.bounds)) return false;
  if (!outer.solid) outer.solid = make_mesh(outer.mesh);
  const double surface = 1e-9 * size_of(outer.bounds);
  const std::vector<Vec3>& points = inner.mesh.vertices;
  bool any = false;
  for (std::size_t v = 0; v < points.size();
       v += std::max<std::size_t>(1, points.size() / samples)) {
    const double distance = outer.solid->distance(points[v]);
    if (distance > surface) return false;
    any = any || distance < -surface;
  }
  return any;
}

void find_containers(std::vector<Shell>& shells) {
  for (std::size_t i = 0; i < shells.size(); ++i)
    for (std::size_t j = i + 1; j < shells.size(); ++j)
      if (is_within(shells[i], shells[j])) shells[i].containers.push_back(j);
}

/// The space that a shell bounds.
enum class Role { solid, cavity, nothing };

/// The winding number around a shell counts the senses of its containers, as seen from the
/// outermost of them.
std::vector<Role> roles(const std::vector<Shell>& shells) {
  const auto sense = [&](std::size_t i) {
    const Shell& s = shells[i];
    return s.sense * (s.containers.empty() ? s.sense : shells[s.containers.back()].sense);
  };
  std::vector<Role> result;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    int around = 0;
    for (const std::size_t k : shells[i].containers) around += sense(k);
    result.push_back(around == 0              ? Role::solid
                     : around + sense(i) == 0 ? Role::cavity
                                              : Role::nothing);
  }
  return result;
}

void append(const TriangleMesh& part, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Triangle& t : part.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Puts solids that may touch into different layers, each with its cavities.
std::vector<TriangleMesh> layers_of(std::vector<Shell>& shells, const std::vector<Role>& role) {
  std::vector<TriangleMesh> layers;
  std::vector<std::vector<std::size_t>> members;
  std::vector<std::size_t> layer_of(shells.size(), 0);
  for (std::size_t i = shells.size(); i-- > 0;) {
    if (role[i] != Role::solid) continue;
    std::size_t layer = 0;
    while (layer < members.size() &&
           std::any_of(
               members[layer].begin(), members[layer].end(),
               [&](std::size_t k) { return touch(shells[i].bounds, shells[k].bounds); }))
      ++layer;
    if (layer == members.size()) {
      members.emplace_back();
      layers.emplace_back();
    }
    members[layer].push_back(i);
    layer_of[i] = layer;
    append(shells[i].mesh, layers[layer]);
  }
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (role[i] != Role::cavity) continue;
    for (const std::size_t k : shells[i].containers) {
      if (role[k] != Role::solid) continue;
      turn(shells[i].mesh);
      append(shells[i].mesh, layers[layer_of[k]]);
      break;
    }
  }
  return layers;
}

/// Number of times that a mesh winds around a point (van Oosterom and Strackee 1983).
double winding_number(const TriangleMesh& mesh, const Vec3& x) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - x, b = mesh.vertices[t[1]] - x,
               c = mesh.vertices[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * pi);
}

/// Checks samples of the surface: the solid must lie on one side of them, and nothing on the other.
/// Where two sheets coincide, as at a cut that joins a hole to an outline, both sides are the same.
void check_sides(const TriangleMesh& mesh, const std::string& where) {
  constexpr std::size_t work = 20'000'000, min_samples = 8, max_samples = 100;
  const std::size_t n = mesh.triangles.size();
  const std::size_t samples = std::clamp(work / (2 * n), min_samples, max_samples);
  for (std::size_t s = 0; s < std::min(samples, n); ++s) {
    const Triangle& t = mesh.triangles[s * n / std::min(samples, n)];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 area = (b - a).cross(c - a), middle = (a + b + c) / 3;
    const double size = std::sqrt(area.norm());
    const double step = 1e-4 * size;
    if (!(step > 1e-12 * (1 + middle.cwiseAbs().maxCoeff()))) continue;
    const Vec3 normal = area.normalized();
    const double outside = winding_number(mesh, middle + step * normal),
                 inside = winding_number(mesh, middle - step * normal);
    const bool is_double = std::abs(inside - outside) < 0.5;  // two sheets that coincide
    if (is_double || (std::abs(outside) < 0.5 && std::abs(inside - 1) < 0.5)) continue;
    std::ostringstream text;
    text << "the surface runs through itself: its triangle around (" << middle.x() << ", "
         << middle.y() << ", " << middle.z() << ") has "
         << (outside > 0.5 ? "the solid" : "nothing")
         << " on both sides; unite its parts in the program that made it";
    throw InputError(where, text.str());
  }
}

void note(std::size_t count, const char* one, const char* several,
          std::vector<std::string>& notes) {
  if (count == 1) notes.push_back(std::string("a shell ") + one);
  if (count > 1) notes.push_back(std::to_string(count) + " shells " + several);
}

std::vector<std::string> notes_on(std::size_t without_volume, const std::vector<Shell>& shells,
                                  const std::vector<Role>& role) {
  std::vector<std::string> notes;
  std::size_t outermost = 0, turned = 0, filled = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    outermost += shells[i].containers.empty();
    turned += shells[i].containers.empty() && shells[i].sense < 0;
    filled += role[i] == Role::nothing;
  }
  if (turned < outermost)  // else the whole file has the other convention
    note(turned, "faced inward and was turned", "faced inward and were turned", notes);
  note(filled, "lies within another and turns the same way: it counts as solid, not as a cavity",
       "lie within others and turn the same way: they count as solid, not as cavities", notes);
  note(without_volume, "has no volume and was left out", "have no volume and were left out", notes);
  return notes;
}

}  // namespace

ShellSolid solid_of_shells(const TriangleMesh& mesh, const std::string& where) {
  std::vector<TriangleMesh> parts = connected_shells(mesh);
  const std::size_t count = parts.size();
  if (count > max_shells)
    throw InputError(where, std::to_string(count) + " separate shells; allowed: up to " +
                                std::to_string(max_shells));
  std::vector<Shell> shells = with_volumes(std::move(parts));
  if (shells.empty()) throw InputError(where, "the mesh encloses no volume");
  find_containers(shells);
  const std::vector<Role> role = roles(shells);
  ShellSolid solid;
  solid.notes = notes_on(count - shells.size(), shells, role);
  solid.layers = layers_of(shells, role);
  for (const TriangleMesh& layer : solid.layers) check_sides(layer, where);
  return solid;
}

TriangleMesh merged_layers(const ShellSolid& solid) {
  TriangleMesh mesh;
  for (const TriangleMesh& layer : solid.layers) append(layer, mesh);
  return mesh;
}

}  // namespace snowshed::geometry
