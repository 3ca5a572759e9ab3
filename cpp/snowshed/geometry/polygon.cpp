#include "snowshed/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snowshed::geometry {
namespace {

double cross(const Point2& o, const Point2& a, const Point2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double length(const Point2& a, const Point2& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

/// The vector, `distance` long, to the right of an edge.
Point2 offset_vector(const Point2& from, const Point2& to, double distance) {
  const double l = length(from, to);
  return {distance * (to[1] - from[1]) / l, -distance * (to[0] - from[0]) / l};
}

Point2 plus(const Point2& a, const Point2& b) { return {a[0] + b[0], a[1] + b[1]}; }

/// The point a + part (b - a).
Point2 between(const Point2& a, const Point2& b, double part) {
  return {a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part};
}

constexpr double mitre_limit = 4.0;

/// Smallest cross product of two sides that is not straight on, in the square of the ring's unit.
constexpr double min_turn = 1e-30;

/// Corners that are no farther apart count as one, in the ring's unit (metres or cells).
constexpr double coincidence_tolerance = 1e-14;

/// The corner at `v` of a ring whose edges are offset.
void add_corner(const Point2& before, const Point2& v, const Point2& after, double distance,
                Ring& moved) {
  const Point2 first = offset_vector(before, v, distance),
               second = offset_vector(v, after, distance);
  const Point2 end = plus(v, first), begin = plus(v, second);
  const Point2 d1{v[0] - before[0], v[1] - before[1]}, d2{after[0] - v[0], after[1] - v[1]};
  const double turn = d1[0] * d2[1] - d1[1] * d2[0];
  if (std::abs(turn) < min_turn) return moved.push_back(end);  // straight on
  // Where the two moved edges meet.
  const double along = ((begin[0] - end[0]) * d2[1] - (begin[1] - end[1]) * d2[0]) / turn;
  const Point2 meet{end[0] + along * d1[0], end[1] + along * d1[1]};
  const double reach = length(v, meet), width = std::abs(distance);
  const bool inner = (turn > 0) == (distance < 0);
  const double max_reach =
      inner ? std::max(1.01 * width, std::min(length(before, v), length(v, after)))
            : mitre_limit * width;
  if (reach <= max_reach) return moved.push_back(meet);
  if (inner) {
    moved.push_back(end);
    moved.push_back(begin);
    return;
  }
  const double bevel = length(v, between(end, begin, 0.5));
  const double part = (max_reach - bevel) / (reach - bevel);
  moved.push_back(between(end, meet, part));
  moved.push_back(between(begin, meet, part));
}

bool segments_meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto side = [](double value) { return (value > 0) - (value < 0); };
  const int c_of_ab = side(cross(a, b, c)), d_of_ab = side(cross(a, b, d));
  const int a_of_cd = side(cross(c, d, a)), b_of_cd = side(cross(c, d, b));
  if (c_of_ab == 0 && d_of_ab == 0) {  // on one line
    const auto overlap = [](double p, double q, double r, double s) {
      return std::max(std::min(p, q), std::min(r, s)) <= std::min(std::max(p, q), std::max(r, s));
    };
    return overlap(a[0], b[0], c[0], d[0]) && overlap(a[1], b[1], c[1], d[1]);
  }
  return c_of_ab * d_of_ab <= 0 && a_of_cd * b_of_cd <= 0;
}

}  // namespace

RingBounds bounds_of(const Ring& ring) {
  RingBounds b{ring[0], ring[0]};
  for (const Point2& p : ring)
    for (const std::size_t axis : {0, 1}) {
      b.low[axis] = std::min(b.low[axis], p[axis]);
      b.high[axis] = std::max(b.high[axis], p[axis]);
    }
  return b;
}

bool contains(const Ring& ring, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2& a = ring[i];
    const Point2& b = ring[(i + 1) % ring.size()];
    const bool a_above = a[1] >= p[1], b_above = b[1] >= p[1];
    if (a_above == b_above) continue;
    if (((b[1] - p[1]) * (a[0] - b[0]) >= (b[0] - p[0]) * (a[1] - b[1])) == b_above)
      inside = !inside;
  }
  return inside;
}

bool contains(const Polygon& polygon, const Point2& point) {
  return contains(polygon.outline, point) &&
         std::none_of(polygon.holes.begin(), polygon.holes.end(),
                      [&](const Ring& hole) { return contains(hole, point); });
}

double twice_signed_area(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    sum += cross(ring.front(), ring[i], ring[(i + 1) % ring.size()]);
  return sum;
}

Ring offset_ring(const Ring& ring, double distance) {
  Ring distinct;
  for (const Point2& p : ring)
    if (distinct.empty() || length(distinct.back(), p) > coincidence_tolerance)
      distinct.push_back(p);
  while (distinct.size() > 1 && length(distinct.back(), distinct.front()) <= coincidence_tolerance)
    distinct.pop_back();
  const std::size_t n = distinct.size();
  if (n < 3) return ring;
  Ring moved;
  for (std::size_t i = 0; i < n; ++i)
    add_corner(distinct[(i + n - 1) % n], distinct[i], distinct[(i + 1) % n], distance, moved);
  return moved;
}

Ring widened(const Ring& ring, double distance) {
  return offset_ring(ring, twice_signed_area(ring) > 0 ? distance : -distance);
}

bool crosses_itself(const Ring& ring) {
  const std::size_t n = ring.size();
  // Edges in the order of their westernmost points: only edges that overlap along x are compared.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  const auto from = [&](std::size_t e) -> const Point2& { return ring[e]; };
  const auto to = [&](std::size_t e) -> const Point2& { return ring[(e + 1) % n]; };
  const auto west = [&](std::size_t e) { return std::min(from(e)[0], to(e)[0]); };
  const auto east = [&](std::size_t e) { return std::max(from(e)[0], to(e)[0]); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return west(a) < west(b); });
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n && west(order[j]) <= east(order[i]); ++j) {
      const std::size_t a = order[i], b = order[j];
      if ((a + 1) % n == b || (b + 1) % n == a) continue;
      if (segments_meet(from(a), to(a), from(b), to(b))) return true;
    }
  return false;
}

double area_within(const Ring& ring, const Point2& low, const Point2& high) {
  Ring inside = ring, clipped;
  for (const int axis : {0, 1})
    for (const bool upper : {false, true}) {
      const double limit = upper ? high[axis] : low[axis];
      const auto keeps = [&](const Point2& p) {
        return upper ? p[axis] <= limit : p[axis] >= limit;
      };
      clipped.clear();
      for (std::size_t i = 0; i < inside.size(); ++i) {
        const Point2 &a = inside[i], &b = inside[(i + 1) % inside.size()];
        if (keeps(a)) clipped.push_back(a);
        if (keeps(a) != keeps(b))
          clipped.push_back(between(a, b, (limit - a[axis]) / (b[axis] - a[axis])));
      }
      inside.swap(clipped);
    }
  return inside.size() < 3 ? 0.0 : 0.5 * std::abs(twice_signed_area(inside));
}

double area_within(const Polygon& polygon, const Point2& low, const Point2& high) {
  double area = area_within(polygon.outline, low, high);
  for (const Ring& hole : polygon.holes) area -= area_within(hole, low, high);
  return std::max(area, 0.0);
}

}  // namespace snowshed::geometry
