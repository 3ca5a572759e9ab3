// Finds pairs of near spheres. Spheres of two grains are found by cells, spheres of plates by their
// grid.
#include <algorithm>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/grains/pair_list.hpp"

namespace snowshed::methods::grains {
namespace {

constexpr int half_grid = 32768;  // spheres of a plate to each side of its origin

std::uint32_t plate_number(int i, int j) {
  return std::uint32_t(i + half_grid) << 16 | std::uint32_t(j + half_grid);
}

/// Cells at least as wide as the distance within which pairs are listed. Spheres outside of the box
/// belong to the cells of its border; if the box is periodic, they belong to the cells of their
/// images inside.
class SphereCells {
 public:
  SphereCells(const PairSearch& s, const std::vector<Vec3>& centers, const Boundary& b,
              double reach)
      : periodic_(s.periodic), boundary_(b) {
    const double bottom = std::min(b.plate[0].z(), b.plate[1].z());
    low_ = Vec3(b.side[0], b.side[2], bottom);
    Vec3 extent(b.period(0), b.period(1), std::abs(b.plate[1].z() - b.plate[0].z()));
    extent = extent.cwiseMax(reach);
    // At most a few cells for each sphere.
    const double volume = extent.prod() / (4.0 * double(centers.size()) + 64);
    const double width = std::max(reach, std::cbrt(volume));
    for (int k = 0; k < 3; ++k) {
      count_[k] = std::max(1, int(std::min(extent[k] / width, 1e6)));
      per_width_[k] = count_[k] / extent[k];
    }
    if (periodic_ && (count_[0] < 3 || count_[1] < 3)) shorten(extent, reach);
    fill(centers);
  }

  int count(int axis) const { return count_[axis]; }
  std::uint32_t sphere(std::uint32_t entry) const { return spheres_[entry]; }
  std::size_t number(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(count_[1]) + std::size_t(j)) * std::size_t(count_[0]) +
           std::size_t(i);
  }
  std::uint32_t begin(std::size_t cell) const { return begin_[cell]; }
  std::uint32_t end(std::size_t cell) const { return begin_[cell + 1]; }
  /// Number of periods by which a sphere lies away from the box.
  int wrap(const Vec3& x, int axis) const {
    return periodic_ ? int(std::floor((x[axis] - low_[axis]) / boundary_.period(axis))) : 0;
  }

 private:
  /// Sets the least number of cells along a period, three. Throws SimulationError if they would be
  /// narrower than `reach`.
  void shorten(const Vec3& extent, double reach) {
    for (int axis = 0; axis < 2; ++axis) {
      if (extent[axis] < 3 * reach)
        throw SimulationError("the period along " + std::string(axis == 0 ? "x" : "y") +
                              " is shorter than four spheres");
      count_[axis] = std::max(3, count_[axis]);
      per_width_[axis] = count_[axis] / extent[axis];
    }
  }
  int cell_index(const Vec3& x, int axis) const {
    const double from_low =
        x[axis] - low_[axis] - (axis < 2 ? wrap(x, axis) * boundary_.period(axis) : 0.0);
    return int(std::clamp(from_low * per_width_[axis], 0.0, count_[axis] - 0.5));
  }
  void fill(const std::vector<Vec3>& centers) {
    begin_.assign(number(0, 0, count_[2]) + 1, 0);
    std::vector<std::uint32_t> cell(centers.size());
    for (std::size_t s = 0; s < centers.size(); ++s) {
      cell[s] = std::uint32_t(
          number(cell_index(centers[s], 0), cell_index(centers[s], 1), cell_index(centers[s], 2)));
      ++begin_[cell[s] + 1];
    }
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    spheres_.resize(centers.size());
    for (std::size_t s = 0; s < centers.size(); ++s) spheres_[begin_[cell[s]]++] = std::uint32_t(s);
    for (std::size_t c = begin_.size() - 1; c > 0; --c) begin_[c] = begin_[c - 1];
    begin_[0] = 0;
  }

  bool periodic_;
  const Boundary& boundary_;
  Vec3 low_;
  int count_[3];
  double per_width_[3];
  std::vector<std::uint32_t> begin_, spheres_;
};

std::vector<Vec3> sphere_centers(const PairSearch& s, const std::vector<GrainPose>& poses) {
  std::vector<Mat3> rotations;
  rotations.reserve(poses.size());
  for (const GrainPose& pose : poses) rotations.push_back(pose.orientation.toRotationMatrix());
  std::vector<Vec3> centers(s.spheres.offsets.size());
  parallel_for_static(std::ptrdiff_t(centers.size()), s.threads, [&](std::ptrdiff_t i) {
    const std::uint32_t g = s.spheres.grain[std::size_t(i)];
    centers[std::size_t(i)] = poses[g].position + rotations[g] * s.spheres.offsets[std::size_t(i)];
  });
  return centers;
}

/// Searches for pairs; spheres are in the order of their cells.
class Finder {
 public:
  Finder(const PairSearch& s, const std::vector<GrainPose>& poses, const Boundary& b)
      : s_(s),
        b_(b),
        reach_(2 * s.radius + s.skin),
        centers_(sphere_centers(s, poses)),
        cells_(s, centers_, b, reach_),
        grain_(centers_.size()) {
    std::vector<Vec3> sorted(centers_.size());
    for (std::uint32_t e = 0; e < sorted.size(); ++e) {
      sorted[e] = centers_[cells_.sphere(e)];
      grain_[e] = s.spheres.grain[cells_.sphere(e)];
    }
    centers_ = std::move(sorted);
  }

  std::vector<PairKey> find() {
    find_grains();
    for (std::uint32_t e = 0; e < centers_.size(); ++e) {
      find_plate(e, 0);
      if (b_.has_top) find_plate(e, 1);
      if (!s_.periodic) find_sides(e);
      if (b_.has_cone) find_cone(e);
    }
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  /// The search runs layer by layer. Pairs are sorted afterwards, so that the result does not
  /// depend on threads.
  void find_grains() {
    std::vector<std::vector<PairKey>> layers(std::size_t(cells_.count(2)));
    parallel_for_dynamic(cells_.count(2), s_.threads, 1, [&](std::ptrdiff_t k) {
      for (int j = 0; j < cells_.count(1); ++j) find_along(j, int(k), layers[std::size_t(k)]);
    });
    std::size_t all = 0;
    for (const std::vector<PairKey>& layer : layers) all += layer.size();
    check_number(all);
    pairs_.reserve(all + all / 8);
    for (std::vector<PairKey>& layer : layers) {
      pairs_.insert(pairs_.end(), layer.begin(), layer.end());
      layer = {};
    }
  }

  /// Compares a row of cells along x, whose spheres are consecutive, with itself and with the four
  /// later rows beside it.
  void find_along(int j, int k, std::vector<PairKey>& pairs) const {
    const int ahead[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    find_between(j, k, j, 0, true, pairs);
    for (const auto& [dj, dk] : ahead) {
      if (k + dk >= cells_.count(2)) continue;
      const int n = cells_.count(1), to = j + dj;
      const int periods = to < 0 ? -1 : to >= n ? 1 : 0;
      if (periods != 0 && !s_.periodic) continue;
      find_between(j, k, to - periods * n, periods, false, pairs, k + dk);
    }
  }

  /// Compares row (j, k) with row (to_j, to_k), which is `periods` away along y.
  void find_between(int j, int k, int to_j, int periods, bool same, std::vector<PairKey>& pairs,
                    int to_k = -1) const {
    const int n = cells_.count(0), l = same ? k : to_k;
    for (int i = 0; i < n; ++i) {
      const std::size_t cell = cells_.number(i, j, k);
      const std::uint32_t begin = cells_.begin(cell), end = cells_.end(cell);
      if (begin == end) continue;
      const std::uint32_t from = cells_.begin(cells_.number(std::max(i - 1, 0), to_j, l));
      const std::uint32_t until = cells_.end(cells_.number(std::min(i + 1, n - 1), to_j, l));
      for (std::uint32_t e = begin; e < end; ++e)
        for (std::uint32_t f = same ? e + 1 : from; f < until; ++f) meet(e, f, 0, periods, pairs);
      if (!s_.periodic) continue;
      if (i == n - 1) meet_cells(cell, cells_.number(0, to_j, l), 1, periods, pairs);
      if (i == 0 && !same) meet_cells(cell, cells_.number(n - 1, to_j, l), -1, periods, pairs);
    }
  }

  void meet_cells(std::size_t cell, std::size_t other, int px, int py,
                  std::vector<PairKey>& pairs) const {
    for (std::uint32_t e = cells_.begin(cell); e < cells_.end(cell); ++e)
      for (std::uint32_t f = cells_.begin(other); f < cells_.end(other); ++f)
        meet(e, f, px, py, pairs);
  }

  void meet(std::uint32_t e, std::uint32_t f, int px, int py, std::vector<PairKey>& pairs) const {
    const std::uint32_t of_e = grain_[e], of_f = grain_[f];
    if (of_e == of_f && !s_.periodic) return;
    int shift[2] = {0, 0};
    Vec3 separation = centers_[f] - centers_[e];
    if (s_.periodic) {
      shift[0] = px + cells_.wrap(centers_[e], 0) - cells_.wrap(centers_[f], 0);
      shift[1] = py + cells_.wrap(centers_[e], 1) - cells_.wrap(centers_[f], 1);
      if (of_e == of_f && shift[0] == 0 && shift[1] == 0) return;
      separation += Vec3(shift[0] * b_.period(0), shift[1] * b_.period(1), 0);
    }
    if (separation.squaredNorm() >= reach_ * reach_) return;
    const bool forward = of_e != of_f ? of_e < of_f : shift[0] != 0 ? shift[0] > 0 : shift[1] > 0;
    check_number(pairs.size());
    const std::uint32_t a = cells_.sphere(e), b = cells_.sphere(f);
    if (forward)
      pairs.push_back({of_e, of_f, {shift[0], shift[1]}, a, b});
    else
      pairs.push_back({of_f, of_e, {-shift[0], -shift[1]}, b, a});
  }

  std::uint32_t partner(Partner p) const { return s_.grains + std::uint32_t(p); }

  void find_plate(std::uint32_t e, int plate) {
    const Vec3 from = centers_[e] - b_.plate[plate];
    if (std::abs(from.z()) >= reach_) return;
    const double spacing = 2 * s_.radius, x = from.x() / spacing, y = from.y() / spacing;
    if (!(std::abs(x) < half_grid - 4 && std::abs(y) < half_grid - 4)) return;
    for (int i = int(std::floor(x)) - 2; i <= int(std::floor(x)) + 2; ++i)
      for (int j = int(std::floor(y)) - 2; j <= int(std::floor(y)) + 2; ++j) {
        const std::uint32_t number = plate_number(i, j);
        if ((plate_sphere(number, s_.radius) - from).squaredNorm() < reach_ * reach_)
          push({grain_[e],
                partner(plate == 0 ? Partner::bottom_plate : Partner::top_plate),
                {0, 0},
                cells_.sphere(e),
                number});
      }
  }

  void find_sides(std::uint32_t e) {
    for (int side = 0; side < 4; ++side)
      if (meet_side(b_, side, centers_[e], s_.radius).gap < s_.skin)
        push(
            {grain_[e], partner(Partner::west) + std::uint32_t(side), {0, 0}, cells_.sphere(e), 0});
  }

  void find_cone(std::uint32_t e) {
    if (meet_cone(s_.cone, centers_[e] - b_.tip, s_.radius).gap < s_.skin)
      push({grain_[e], partner(Partner::cone), {0, 0}, cells_.sphere(e), 0});
  }

  void push(const PairKey& key) {
    check_number(pairs_.size());
    pairs_.push_back(key);
  }

  void check_number(std::size_t pairs) const {
    if (pairs > s_.max_pairs)
      throw SimulationError("the grains overlap so much that more than " +
                            std::to_string(s_.max_pairs) + " pairs of spheres are near");
  }

  const PairSearch& s_;
  const Boundary& b_;
  double reach_;
  std::vector<Vec3> centers_;
  SphereCells cells_;
  std::vector<std::uint32_t> grain_;
  std::vector<PairKey> pairs_;
};

}  // namespace

Vec3 plate_sphere(std::uint32_t number, double radius) {
  const int i = int(number >> 16) - half_grid, j = int(number & 0xffff) - half_grid;
  return {(2 * i + 1) * radius, (2 * j + 1) * radius, 0};
}

std::vector<PairKey> find_pairs(const PairSearch& search, const std::vector<GrainPose>& poses,
                                const Boundary& boundary) {
  return Finder(search, poses, boundary).find();
}

}  // namespace snowshed::methods::grains
