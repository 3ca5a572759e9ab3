#include "snowshed/sampling/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/sampling/voxel_set.hpp"

namespace snowshed::sampling {
namespace {

constexpr double rounding = 1e-6;  // share of a cell

/// A cell of the lattice, and how much of it is within the solid.
struct Cell {
  Vec3 center;
  double share;

  bool is_full() const { return share > 1 - rounding; }
};

std::size_t count_for(double volume, int dimension, double spacing) {
  // Half a cell counts as a cell, in spite of rounding.
  const double count = std::floor(volume / std::pow(spacing, dimension) + 0.5 + rounding);
  if (count > max_particles)
    throw InputError("particles to fill the solid",
                     std::to_string(count) + "; at most 2e8 are possible: choose a larger spacing");
  if (count < 1) throw InputError("", "the solid is too small for the spacing to hold a particle");
  return std::size_t(count);
}

/// The cells of a box, of which the last layer along each edge may be cut.
std::vector<Cell> cells_of(const geometry::OrientedBox& box, int dimension, double spacing) {
  std::array<std::size_t, 3> counts{1, 1, 1}, cut_layer{};
  std::array<double, 3> part{1, 1, 1};  // share of the cut layer that lies within
  Vec3 center = box.center;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && dimension == 2) continue;
    const double layers = 2 * box.half[axis] / spacing;
    const double full = std::floor(layers + rounding), left = layers - full;
    if (left > rounding) part[axis] = left;
    counts[axis] = std::size_t(full) + (left > rounding);
    // The first layer lies against the lower face, because there may be an obstacle below.
    const double up = box.axes(2, axis) < -rounding ? -1 : 1;
    cut_layer[axis] = up > 0 ? counts[axis] - 1 : 0;
    const double shorter = box.half[axis] - 0.5 * double(counts[axis]) * spacing;
    center -= up * shorter * box.axes.col(axis);
  }
  std::vector<Cell> cells;
  cells.reserve(counts[0] * counts[1] * counts[2]);
  for (std::size_t i = 0; i < counts[0]; ++i)
    for (std::size_t j = 0; j < counts[1]; ++j)
      for (std::size_t k = 0; k < counts[2]; ++k) {
        const Vec3 steps(double(i) - 0.5 * double(counts[0] - 1),
                         double(j) - 0.5 * double(counts[1] - 1),
                         double(k) - 0.5 * double(counts[2] - 1));
        const double share = (i == cut_layer[0] ? part[0] : 1) * (j == cut_layer[1] ? part[1] : 1) *
                             (k == cut_layer[2] ? part[2] : 1);
        cells.push_back({center + spacing * (box.axes * steps), share});
      }
  return cells;
}

/// The vector from the centre of a solid's bounds to a corner of a lattice that begins at their
/// lowest corner.
Vec3 shift_to_lowest_corner(const geometry::Bounds& bounds, double spacing) {
  const Vec3 half = (bounds.max - bounds.min) / 2;
  Vec3 shift = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (std::isfinite(half[axis]))
      shift[axis] = std::ceil(half[axis] / spacing - rounding) * spacing - half[axis];
  return shift;
}

/// The same for another solid: its lattice begins at the lowest corner of its bounds.
std::vector<Cell> cells_of(const geometry::LevelSet& shape, int dimension, double spacing,
                           const StopRequest& stop) {
  const Vec3 shift = shift_to_lowest_corner(shape.bounds(), spacing);
  const std::vector<Voxel> voxels = voxelize(shape, dimension, spacing, 0.0, stop, shift);
  const std::vector<double> shares = shares_within(shape, dimension, spacing, voxels, stop);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (shares[i] > 0) cells.push_back({voxels[i].center, shares[i]});
  return cells;
}

/// Chooses among the cells that the surface cuts. Each group of neighbouring cells gets points in
/// proportion to the snow in its cells: the fullest cells first, and among equally full cells those
/// that are farthest apart.
class CutCells {
 public:
  void add(const Cell& cell) { cells_.push_back(cell); }

  /// Calls place(center) for `wanted` of these cells.
  template <class Place>
  void choose(std::size_t wanted, Place place) {
    double sum = 0;
    for (const Cell& cell : cells_) sum += cell.share;
    const double scale = sum > 0 ? double(wanted) / sum : 0;
    double due = 0;
    std::size_t placed = 0;
    for (std::size_t begin = 0; begin < cells_.size(); begin += group) {
      const std::size_t end = std::min(begin + group, cells_.size());
      for (std::size_t i = begin; i < end; ++i) due += scale * cells_[i].share;
      std::array<std::size_t, group> order = ranked(begin, end);
      for (std::size_t k = 0; k < end - begin && placed < std::size_t(std::round(due)); ++k) {
        place(cells_[order[k]].center);
        ++placed;
      }
    }
  }

 private:
  static constexpr std::size_t group = 16;

  /// 0, 8, 4, 12, 2, ...: the four bits in reverse.
  static std::size_t spread(std::size_t i) {
    return (i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3;
  }

  std::array<std::size_t, group> ranked(std::size_t begin, std::size_t end) const {
    // Sorted by share; shares are rounded, so that equal cells remain equal.
    std::array<std::size_t, group> order{};
    for (std::size_t i = begin; i < end; ++i) order[i - begin] = i;
    std::sort(order.begin(), order.begin() + std::ptrdiff_t(end - begin),
              [&](std::size_t a, std::size_t b) {
                const auto level = [&](std::size_t i) { return std::round(cells_[i].share * 1e4); };
                if (level(a) != level(b)) return level(a) > level(b);
                return spread(a - begin) < spread(b - begin);
              });
    return order;
  }

  std::vector<Cell> cells_;
};

/// The nearest point that is not outside of the solid.
Vec3 moved_within(const geometry::LevelSet& shape, Vec3 x, int dimension, double spacing) {
  for (int turn = 0; turn < 3; ++turn) {
    const double outside = shape.distance(x);
    if (!(outside > 0)) break;
    x -= (outside + 1e-9 * spacing) * shape.normal(x);
    if (dimension == 2) x.y() = 0;
  }
  return x;
}

}  // namespace

std::size_t count_lattice(const geometry::LevelSet& shape, int dimension, double spacing,
                          const StopRequest& stop) {
  return count_for(measure(shape, dimension, spacing, stop), dimension, spacing);
}

LatticeFilling fill_lattice(const geometry::LevelSet& shape, int dimension, double spacing,
                            const StopRequest& stop) {
  LatticeFilling filling;
  filling.volume = measure(shape, dimension, spacing, stop);
  const std::size_t count = count_for(filling.volume, dimension, spacing);
  const auto box = scene_box(shape, dimension);
  CutCells cut;
  for (const Cell& cell :
       box ? cells_of(*box, dimension, spacing) : cells_of(shape, dimension, spacing, stop)) {
    if (cell.is_full())
      filling.positions.push_back(cell.center);
    else
      cut.add(cell);
  }
  const std::size_t full = filling.positions.size();
  cut.choose(count > full ? count - full : 0, [&](const Vec3& center) {
    filling.positions.push_back(moved_within(shape, center, dimension, spacing));
  });
  return filling;
}

}  // namespace snowshed::sampling
