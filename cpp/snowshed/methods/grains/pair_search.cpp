// Finds near spheres: cells of spheres for those of two grains, the grid for those of plates.
#include <algorithm>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/grains/pair_list.hpp"

namespace snowshed {
namespace {

constexpr int half_grid = 32768;  // spheres of a plate to each side of its origin

std::uint32_t plate_number(int i, int j) {
  return std::uint32_t(i + half_grid) << 16 | std::uint32_t(j + half_grid);
}

/// Cells at least as wide as pairs are far apart. What lies outside of the box belongs to the
/// cells of its border, or to those of its image where the box is periodic.
class SphereCells {
 public:
  SphereCells(const PairSearch& s, const std::vector<Vec3>& places, const GrainsBoundary& b,
              double reach)
      : periodic_(s.periodic), boundary_(b) {
    const double bottom = std::min(b.plate[0].z(), b.plate[1].z());
    low_ = Vec3(b.side[0], b.side[2], bottom);
    Vec3 extent(b.period(0), b.period(1), std::abs(b.plate[1].z() - b.plate[0].z()));
    extent = extent.cwiseMax(reach);
    // No more cells than a few for each sphere.
    const double volume = extent.prod() / (4.0 * double(places.size()) + 64);
    const double width = std::max(reach, std::cbrt(volume));
    for (int k = 0; k < 3; ++k) {
      count_[k] = std::max(1, int(std::min(extent[k] / width, 1e6)));
      per_width_[k] = count_[k] / extent[k];
    }
    if (periodic_ && (count_[0] < 3 || count_[1] < 3)) shorten(extent, reach);
    fill(places);
  }

  int count(int axis) const { return count_[axis]; }
  std::uint32_t sphere(std::uint32_t entry) const { return spheres_[entry]; }
  std::uint32_t begin(int i, int j, int k) const { return begin_[number(i, j, k)]; }
  std::uint32_t end(int i, int j, int k) const { return begin_[number(i, j, k) + 1]; }
  /// By how many periods a sphere lies away from the box.
  int wrap(const Vec3& x, int axis) const {
    return periodic_ ? int(std::floor((x[axis] - low_[axis]) / boundary_.period(axis))) : 0;
  }

 private:
  std::size_t number(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(count_[1]) + std::size_t(j)) * std::size_t(count_[0]) +
           std::size_t(i);
  }
  /// Three cells along a period are enough, if they are as wide as pairs are far apart.
  void shorten(const Vec3& extent, double reach) {
    for (int axis = 0; axis < 2; ++axis) {
      if (extent[axis] < 3 * reach)
        throw SimulationError("the period along " + std::string(axis == 0 ? "x" : "y") +
                              " is shorter than four spheres");
      count_[axis] = std::max(3, count_[axis]);
      per_width_[axis] = count_[axis] / extent[axis];
    }
  }
  int place(const Vec3& x, int axis) const {
    const double from_low =
        x[axis] - low_[axis] - (axis < 2 ? wrap(x, axis) * boundary_.period(axis) : 0.0);
    return int(std::clamp(from_low * per_width_[axis], 0.0, count_[axis] - 0.5));
  }
  void fill(const std::vector<Vec3>& places) {
    begin_.assign(number(0, 0, count_[2]) + 1, 0);
    std::vector<std::uint32_t> cell(places.size());
    for (std::size_t s = 0; s < places.size(); ++s) {
      cell[s] =
          std::uint32_t(number(place(places[s], 0), place(places[s], 1), place(places[s], 2)));
      ++begin_[cell[s] + 1];
    }
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    spheres_.resize(places.size());
    for (std::size_t s = 0; s < places.size(); ++s) spheres_[begin_[cell[s]]++] = std::uint32_t(s);
    for (std::size_t c = begin_.size() - 1; c > 0; --c) begin_[c] = begin_[c - 1];
    begin_[0] = 0;
  }

  bool periodic_;
  const GrainsBoundary& boundary_;
  Vec3 low_;
  int count_[3];
  double per_width_[3];
  std::vector<std::uint32_t> begin_, spheres_;
};

class Finder {
 public:
  Finder(const PairSearch& s, const std::vector<GrainPose>& poses, const GrainsBoundary& b)
      : s_(s), b_(b), reach_(2 * s.radius + s.skin), places_(s.spheres.offsets.size()) {
    std::vector<Mat3> rotations;
    rotations.reserve(poses.size());
    for (const GrainPose& pose : poses) rotations.push_back(pose.orientation.toRotationMatrix());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::uint32_t g = s.spheres.grain[i];
      places_[i] = poses[g].position + rotations[g] * s.spheres.offsets[i];
    }
  }

  std::vector<PairKey> find() {
    find_grains();
    for (std::uint32_t a = 0; a < places_.size(); ++a) {
      find_plate(a, 0);
      if (b_.has_top) find_plate(a, 1);
      if (!s_.periodic) find_sides(a);
      if (b_.has_cone) find_cone(a);
    }
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  void find_grains() {
    const SphereCells cells(s_, places_, b_, reach_);
    for (int k = 0; k < cells.count(2); ++k)
      for (int j = 0; j < cells.count(1); ++j)
        for (int i = 0; i < cells.count(0); ++i) {
          const std::uint32_t begin = cells.begin(i, j, k), end = cells.end(i, j, k);
          if (begin == end) continue;
          for (std::uint32_t e = begin; e < end; ++e)
            for (std::uint32_t f = e + 1; f < end; ++f)
              meet(cells, cells.sphere(e), cells.sphere(f), 0, 0);
          find_ahead(cells, i, j, k);
        }
  }

  /// The thirteen neighbours of a cell that come after it.
  void find_ahead(const SphereCells& cells, int i, int j, int k) {
    for (int dk = 0; dk <= 1; ++dk)
      for (int dj = dk == 0 ? 0 : -1; dj <= 1; ++dj)
        for (int di = dk == 0 && dj == 0 ? 1 : -1; di <= 1; ++di) {
          int to[2] = {i + di, j + dj}, periods[2] = {0, 0};
          if (k + dk >= cells.count(2) || !wrapped(cells, to, periods)) continue;
          for (std::uint32_t e = cells.begin(i, j, k); e < cells.end(i, j, k); ++e)
            for (std::uint32_t f = cells.begin(to[0], to[1], k + dk);
                 f < cells.end(to[0], to[1], k + dk); ++f)
              meet(cells, cells.sphere(e), cells.sphere(f), periods[0], periods[1]);
        }
  }

  /// Brings a cell into the box, and tells by how many periods; false where there is none.
  bool wrapped(const SphereCells& cells, int (&to)[2], int (&periods)[2]) const {
    for (int axis = 0; axis < 2; ++axis) {
      const int n = cells.count(axis);
      if (to[axis] >= 0 && to[axis] < n) continue;
      if (!s_.periodic) return false;
      periods[axis] = to[axis] < 0 ? -1 : 1;
      to[axis] -= periods[axis] * n;
    }
    return true;
  }

  void meet(const SphereCells& cells, std::uint32_t a, std::uint32_t b, int px, int py) {
    const std::uint32_t of_a = s_.spheres.grain[a], of_b = s_.spheres.grain[b];
    if (of_a == of_b && !s_.periodic) return;
    int shift[2] = {0, 0};
    Vec3 way = places_[b] - places_[a];
    if (s_.periodic) {
      shift[0] = px + cells.wrap(places_[a], 0) - cells.wrap(places_[b], 0);
      shift[1] = py + cells.wrap(places_[a], 1) - cells.wrap(places_[b], 1);
      if (of_a == of_b && shift[0] == 0 && shift[1] == 0) return;
      way += Vec3(shift[0] * b_.period(0), shift[1] * b_.period(1), 0);
    }
    if (way.squaredNorm() >= reach_ * reach_) return;
    const bool forward = of_a != of_b ? of_a < of_b : shift[0] != 0 ? shift[0] > 0 : shift[1] > 0;
    if (forward)
      push({of_a, of_b, {shift[0], shift[1]}, a, b});
    else
      push({of_b, of_a, {-shift[0], -shift[1]}, b, a});
  }

  std::uint32_t partner(Partner p) const { return s_.grains + std::uint32_t(p); }

  void find_plate(std::uint32_t a, int plate) {
    const Vec3 from = places_[a] - b_.plate[plate];
    if (std::abs(from.z()) >= reach_) return;
    const double spacing = 2 * s_.radius, x = from.x() / spacing, y = from.y() / spacing;
    if (!(std::abs(x) < half_grid - 4 && std::abs(y) < half_grid - 4)) return;
    for (int i = int(std::floor(x)) - 2; i <= int(std::floor(x)) + 2; ++i)
      for (int j = int(std::floor(y)) - 2; j <= int(std::floor(y)) + 2; ++j) {
        const std::uint32_t number = plate_number(i, j);
        if ((plate_sphere(number, s_.radius) - from).squaredNorm() < reach_ * reach_)
          push({s_.spheres.grain[a],
                partner(plate == 0 ? Partner::bottom_plate : Partner::top_plate),
                {0, 0},
                a,
                number});
      }
  }

  void find_sides(std::uint32_t a) {
    for (int side = 0; side < 4; ++side)
      if (meet_side(b_, side, places_[a], s_.radius).gap < s_.skin)
        push({s_.spheres.grain[a], partner(Partner::west) + std::uint32_t(side), {0, 0}, a, 0});
  }

  void find_cone(std::uint32_t a) {
    if (meet_cone(s_.cone, places_[a] - b_.tip, s_.radius).gap < s_.skin)
      push({s_.spheres.grain[a], partner(Partner::cone), {0, 0}, a, 0});
  }

  void push(const PairKey& key) {
    if (pairs_.size() == s_.most_pairs)
      throw SimulationError("the grains overlap so much that more than " +
                            std::to_string(s_.most_pairs) + " pairs of spheres are near");
    pairs_.push_back(key);
  }

  const PairSearch& s_;
  const GrainsBoundary& b_;
  double reach_;
  std::vector<Vec3> places_;
  std::vector<PairKey> pairs_;
};

}  // namespace

Vec3 plate_sphere(std::uint32_t number, double radius) {
  const int i = int(number >> 16) - half_grid, j = int(number & 0xffff) - half_grid;
  return {(2 * i + 1) * radius, (2 * j + 1) * radius, 0};
}

std::vector<PairKey> find_pairs(const PairSearch& search, const std::vector<GrainPose>& poses,
                                const GrainsBoundary& boundary) {
  return Finder(search, poses, boundary).find();
}

}  // namespace snowshed
