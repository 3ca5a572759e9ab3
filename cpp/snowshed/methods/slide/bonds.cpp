#include "snowshed/methods/slide/bonds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "snowshed/particles/point_grid.hpp"

namespace snowshed::methods::slide {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double max_length_ratio = 1.1;

class MapPoints {
 public:
  MapPoints(const Particles& particles, std::size_t begin, double reach, const StopRequest& stop)
      : points_(points_of(particles, begin)), grid_(points_, reach, stop), reach_(reach) {}

  /// Calls visit(triangle, longest side) for the Delaunay triangles with no side beyond the reach,
  /// each once. A triangle belongs to the triangulation if no other point lies within its
  /// circumscribed circle.
  template <class Visit>
  void for_each_triangle(Visit visit, const StopRequest& stop) const {
    StopCheck give_up(stop);
    std::vector<std::uint32_t> near;
    for (std::uint32_t a = 0; a < points_.size(); ++a) {
      give_up();
      near.clear();
      grid_.for_each_near(points_[a], [&](std::uint32_t b, const Vec3& p) {
        if (b > a && (p - points_[a]).norm() <= reach_) near.push_back(b);
      });
      std::sort(near.begin(), near.end());
      for (std::size_t i = 0; i < near.size(); ++i)
        for (std::size_t j = i + 1; j < near.size(); ++j) {
          const Triangle t{a, near[i], near[j]};
          const double longest = longest_side(t);
          if (longest <= reach_ && is_delaunay(t)) visit(t, longest);
        }
    }
  }

 private:
  static std::vector<Vec3> points_of(const Particles& particles, std::size_t begin) {
    std::vector<Vec3> points;
    points.reserve(particles.size() - begin);
    for (std::size_t i = begin; i < particles.size(); ++i)
      points.push_back({particles.x[i], 0.0, particles.y[i]});
    return points;
  }

  double longest_side(const Triangle& t) const {
    return std::max({(points_[t[0]] - points_[t[1]]).norm(), (points_[t[1]] - points_[t[2]]).norm(),
                     (points_[t[2]] - points_[t[0]]).norm()});
  }

  bool is_delaunay(const Triangle& t) const {
    const Vec3& o = points_[t[0]];
    const double bx = points_[t[1]].x() - o.x(), by = points_[t[1]].z() - o.z();
    const double cx = points_[t[2]].x() - o.x(), cy = points_[t[2]].z() - o.z();
    const double d = 2 * (bx * cy - by * cx), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    if (std::abs(d) < 1e-6 * (b2 + c2)) return false;  // almost no area
    const Vec3 center{o.x() + (cy * b2 - by * c2) / d, 0.0, o.z() + (bx * c2 - cx * b2) / d};
    const double radius = (1 - 1e-9) * (center - o).norm();
    // The radius of the circle is within the reach, too, because the triangle is not too flat.
    bool empty = true;
    grid_.for_each_near(center, [&](std::uint32_t i, const Vec3& p) {
      if (i != t[0] && i != t[1] && i != t[2] && (p - center).norm() < radius) empty = false;
    });
    return empty;
  }

  std::vector<Vec3> points_;
  particles::PointGrid grid_;
  double reach_;
};

/// Whether the straight line between two points crosses a ring.
bool crosses(const geometry::Ring& ring, const geometry::Point2& a, const geometry::Point2& b) {
  const auto side = [](const geometry::Point2& o, const geometry::Point2& p,
                       const geometry::Point2& q) {
    return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const geometry::Point2& c = ring[i];
    const geometry::Point2& d = ring[(i + 1) % ring.size()];
    if (std::max(c[0], d[0]) < std::min(a[0], b[0]) || std::min(c[0], d[0]) > std::max(a[0], b[0]))
      continue;
    if ((side(a, b, c) > 0) != (side(a, b, d) > 0) && (side(c, d, a) > 0) != (side(c, d, b) > 0))
      return true;
  }
  return false;
}

bool crosses_outline(const std::vector<Area>& areas, const geometry::Point2& a,
                     const geometry::Point2& b) {
  for (const Area& area : areas) {
    if (crosses(area.polygon.outline, a, b)) return true;
    for (const geometry::Ring& hole : area.polygon.holes)
      if (crosses(hole, a, b)) return true;
  }
  return false;
}

/// A set of pairs of points in little memory: each first point has a chain of its second points.
class PairSet {
 public:
  explicit PairSet(std::size_t points) : newest_(points, end) {}

  /// Returns whether the pair is new.
  bool insert(std::uint32_t first, std::uint32_t second) {
    for (std::uint32_t i = newest_[first]; i != end; i = links_[i].older)
      if (links_[i].second == second) return false;
    links_.push_back({second, newest_[first]});
    newest_[first] = std::uint32_t(links_.size() - 1);
    return true;
  }

 private:
  struct Link {
    std::uint32_t second, older;
  };
  static constexpr std::uint32_t end = 0xffffffff;
  std::vector<std::uint32_t> newest_;
  std::vector<Link> links_;
};

}  // namespace

Bonds bonds_between(const Particles& particles, std::size_t begin, double spacing,
                    const std::vector<Area>* areas, const StopRequest& stop) {
  StopCheck give_up(stop);
  Bonds bonds;
  if (particles.size() < begin + 3) return bonds;
  const MapPoints points(particles, begin, max_length_ratio * spacing * (1 + 1e-6), stop);
  std::vector<std::pair<Triangle, double>> triangles;
  points.for_each_triangle(
      [&](const Triangle& t, double longest) { triangles.push_back({t, longest}); }, stop);
  double shortest = spacing;
  for (const auto& [t, longest] : triangles) shortest = std::min(shortest, longest);

  PairSet known(particles.size() - begin);
  const auto connect = [&](std::uint32_t a, std::uint32_t b) {
    if (!known.insert(a, b)) return;
    give_up();
    const std::size_t i = begin + a, j = begin + b;
    if (areas &&
        crosses_outline(*areas, {particles.x[i], particles.y[i]}, {particles.x[j], particles.y[j]}))
      return;
    const Vec3 along{particles.x[j] - particles.x[i], particles.y[j] - particles.y[i],
                     particles.z[j] - particles.z[i]};
    bonds.add(std::uint32_t(i), std::uint32_t(j), along.norm());
  };
  for (const auto& [t, longest] : triangles) {
    if (longest > max_length_ratio * shortest) continue;
    connect(t[0], t[1]);
    connect(t[0], t[2]);
    connect(t[1], t[2]);
  }
  return bonds;
}

double bond_share(bool thinned, const double* mass, const double* fresh_mass, std::uint32_t first,
                  std::uint32_t second) {
  if (!thinned) return 1;
  return std::min({1.0, mass[first] / fresh_mass[first], mass[second] / fresh_mass[second]});
}

double max_bond_step(const Bonds& bonds, const Particles& particles,
                     const AlignedVector<double>& thickness, double modulus, bool thinned) {
  std::vector<double> stiffness(particles.size(), 0.0);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const std::uint32_t k = bonds.first[b], l = bonds.second[b];
    const double share =
        bond_share(thinned, particles.mass.data(), particles.fresh_mass.data(), k, l);
    const double each = share * modulus * 0.5 * (thickness[k] + thickness[l]) / std::sqrt(3.0);
    stiffness[k] += each;
    stiffness[l] += each;
  }
  double square = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    square = std::max(square, 2 * stiffness[i] / particles.mass[i]);
  return std::sqrt(2 / square);
}

void renumber(Bonds& bonds, const std::vector<std::uint32_t>& new_index) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const std::uint32_t first = new_index[bonds.first[b]], second = new_index[bonds.second[b]];
    if (first == removed_particle || second == removed_particle) continue;
    bonds.first[count] = first;
    bonds.second[count] = second;
    bonds.rest_length[count++] = bonds.rest_length[b];
  }
  bonds.first.resize(count);
  bonds.second.resize(count);
  bonds.rest_length.resize(count);
}

void remove_bonds(Bonds& bonds, const std::vector<char>& marked) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    if (marked[b]) continue;
    bonds.first[count] = bonds.first[b];
    bonds.second[count] = bonds.second[b];
    bonds.rest_length[count++] = bonds.rest_length[b];
  }
  bonds.first.resize(count);
  bonds.second.resize(count);
  bonds.rest_length.resize(count);
}

void BondLists::update(const Bonds& bonds, std::size_t particles) {
  begin_.assign(particles + 1, 0);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    ++begin_[bonds.first[b] + 1];
    ++begin_[bonds.second[b] + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  entry_.resize(2 * bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    entry_[begin_[bonds.first[b]]++] = std::uint32_t(2 * b);
    entry_[begin_[bonds.second[b]]++] = std::uint32_t(2 * b + 1);
  }
  for (std::size_t i = begin_.size() - 1; i > 0; --i) begin_[i] = begin_[i - 1];
  begin_[0] = 0;
}

}  // namespace snowshed::methods::slide
