#include "snowshed/geometry/polygon_faces.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/orientation.hpp"

namespace snowshed::geometry {
namespace {

/// Comparisons of a corner with an ear, over all faces of a file; they take some seconds.
constexpr std::size_t max_comparisons = 300'000'000;

/// The corners of a face as they lie in a plane, counter-clockwise.
struct Outline {
  Face corners;
  std::vector<Point2> points;
};

/// Twice the area vector of a face (Newell).
Vec3 area_vector(const std::vector<Vec3>& vertices, const Face& face) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = vertices[face.front()];
  for (std::size_t i = 0; i < face.size(); ++i)
    sum += (vertices[face[i]] - origin).cross(vertices[face[(i + 1) % face.size()]] - origin);
  return sum;
}

/// Projects a face along the axis nearest to its area vector, which rounds nothing.
Outline flattened(const std::vector<Vec3>& vertices, const Face& face, const Vec3& area) {
  int away;
  area.cwiseAbs().maxCoeff(&away);
  int u = (away + 1) % 3, v = (away + 2) % 3;
  if (area[away] < 0) std::swap(u, v);
  Outline outline{face, {}};
  for (const std::uint32_t corner : face)
    outline.points.push_back({vertices[corner][u], vertices[corner][v]});
  return outline;
}

/// Drops repeated corners, and begins with the corner of the smallest coordinates.
Face without_repetitions(const std::vector<Vec3>& vertices, const Face& face) {
  Face corners;
  for (const std::uint32_t corner : face)
    if (corners.empty() || vertices[corner] != vertices[corners.back()]) corners.push_back(corner);
  while (corners.size() > 1 && vertices[corners.back()] == vertices[corners.front()])
    corners.pop_back();
  // Two faces that coincide and turn opposite ways are then cut alike.
  std::rotate(corners.begin(),
              std::min_element(corners.begin(), corners.end(),
                               [&](auto a, auto b) {
                                 const Vec3 &p = vertices[a], &q = vertices[b];
                                 return std::lexicographical_compare(p.data(), p.data() + 3,
                                                                     q.data(), q.data() + 3);
                               }),
              corners.end());
  return corners;
}

bool is_convex(const Outline& outline) {
  const auto& p = outline.points;
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(orientation(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0)) return false;
  for (std::size_t i = 2; i + 1 < n; ++i)  // turns around only once
    if (!(orientation(p[0], p[i], p[i + 1]) > 0)) return false;
  return true;
}

/// Cuts triangles off a polygon until none is left.
class EarClipper {
 public:
  EarClipper(const Outline& outline, std::size_t& comparisons)
      : p_(outline.points),
        corners_(outline.corners),
        left_(p_.size()),
        comparisons_(comparisons),
        before_(p_.size()),
        after_(p_.size()) {
    for (std::size_t i = 0; i < left_; ++i) {
      before_[i] = (i + left_ - 1) % left_;
      after_[i] = (i + 1) % left_;
    }
  }

  /// Returns false if no ear can be cut although the rest has an area.
  bool clip(std::vector<Triangle>& triangles) {
    std::size_t i = 0, since_cut = 0;
    while (left_ > 3) {
      if (since_cut > left_) return is_flat(i) && fan(i, triangles);
      if (!is_ear(i)) {
        i = after_[i];
        ++since_cut;
        continue;
      }
      cut(i, triangles);
      i = after_[after_[i]];  // so that not all ears share a corner
      since_cut = 0;
    }
    if (orientation(p_[before_[i]], p_[i], p_[after_[i]]) < 0) return false;
    cut(i, triangles);
    return true;
  }

 private:
  void cut(std::size_t i, std::vector<Triangle>& triangles) {
    triangles.push_back({corners_[before_[i]], corners_[i], corners_[after_[i]]});
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
    --left_;
  }

  /// Whether the triangle at i can be cut off. No other corner may lie in it or on its border. A
  /// corner at the point of i itself is allowed unless its edges lead into the triangle.
  bool is_ear(std::size_t i) {
    const std::size_t first = before_[i], last = after_[i];
    const Point2 &a = p_[first], &b = p_[i], &c = p_[last];
    if (a == c) return true;  // the outline leads to a point and back
    if (!(orientation(a, b, c) > 0)) return false;
    for (std::size_t k = after_[last]; k != first; k = after_[k]) {
      if (++comparisons_ > max_comparisons) return false;
      const Point2& q = p_[k];
      if (q == a || q == c) continue;
      if (q == b) {
        if (is_within_corner(a, b, c, p_[before_[k]]) || is_within_corner(a, b, c, p_[after_[k]]))
          return false;
        continue;
      }
      if (orientation(a, b, q) >= 0 && orientation(b, c, q) >= 0 && orientation(c, a, q) >= 0)
        return false;
    }
    return true;
  }

  static bool is_within_corner(const Point2& a, const Point2& b, const Point2& c, const Point2& q) {
    return orientation(a, b, q) > 0 && orientation(b, c, q) > 0;
  }

  bool is_flat(std::size_t i) const {
    std::size_t k = i;
    do {
      if (orientation(p_[before_[k]], p_[k], p_[after_[k]]) != 0) return false;
      k = after_[k];
    } while (k != i);
    return true;
  }

  /// Cuts the rest into triangles without area, which keep the neighbouring faces connected.
  bool fan(std::size_t i, std::vector<Triangle>& triangles) {
    while (left_ > 2) cut(after_[i], triangles);
    return true;
  }

  const std::vector<Point2>& p_;
  const Face& corners_;
  std::size_t left_;
  std::size_t& comparisons_;
  std::vector<std::size_t> before_, after_;
};

void append_fan(const Face& face, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < face.size(); ++i)
    triangles.push_back({face[0], face[i - 1], face[i]});
}

[[noreturn]] void refuse(const std::string& where, const TriangleMesh& mesh, const Face& face,
                         const char* why) {
  const Vec3& at = mesh.vertices[face.front()];
  std::ostringstream text;
  text << "the face of " << face.size() << " corners that begins at (" << at.x() << ", " << at.y()
       << ", " << at.z() << ") " << why;
  throw InputError(where, text.str());
}

}  // namespace

void FaceCutter::append(const Face& given, TriangleMesh& mesh) {
  if (given.size() == 3) return append_fan(given, mesh.triangles);
  const Face face = without_repetitions(mesh.vertices, given);
  if (face.size() < 3) return;
  const Vec3 area = area_vector(mesh.vertices, face);
  if (face.size() == 3 || area.isZero(0.0)) return append_fan(face, mesh.triangles);
  const Outline outline = flattened(mesh.vertices, face, area);
  if (is_convex(outline)) return append_fan(face, mesh.triangles);
  EarClipper clipper(outline, comparisons_);
  const bool is_simple = clipper.clip(mesh.triangles);
  if (comparisons_ > max_comparisons)
    refuse(where_, mesh, face,
           "is one concave face too many to cut into triangles; give triangles instead");
  if (!is_simple) refuse(where_, mesh, face, "has an outline that crosses itself");
}

}  // namespace snowshed::geometry
