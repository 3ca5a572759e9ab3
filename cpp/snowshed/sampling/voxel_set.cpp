#include "snowshed/sampling/voxel_set.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/bounds.hpp"

namespace snowshed::sampling {
namespace {

constexpr std::size_t max_boundary_cells = 200'000'000;
constexpr int max_levels = 20;

void require_bounded(const geometry::Bounds& bounds, int dimension) {
  if (!geometry::is_finite(bounds, dimension))
    throw InputError("", "the solid is unbounded; only bounded solids can be filled or measured");
}

/// Recursive subdivision of a solid into cells. Each cell is halved along every axis of the scene,
/// down to a given edge.
class Subdivision {
 public:
  struct Root {
    Vec3 center;
    int levels;
  };

  Subdivision(const geometry::LevelSet& shape, int dimension, const StopRequest& stop)
      : shape_(shape), bounds_(shape.bounds()), dimension_(dimension), check_stop_(stop) {}

  /// Returns the smallest cell with edge `edge` * 2^levels that covers the solid and the margin.
  /// Its centre is `shift` from that of the solid's bounds.
  Root root(double edge, double margin, const Vec3& shift = Vec3::Zero()) const {
    require_bounded(bounds_, dimension_);
    Root root{(bounds_.min + bounds_.max) / 2 + shift, 0};
    Vec3 size = bounds_.max - bounds_.min + 2 * shift.cwiseAbs();
    if (dimension_ == 2) root.center.y() = size.y() = 0;
    while (std::ldexp(edge, root.levels) < size.maxCoeff() + 2 * margin)
      if (++root.levels > max_levels) refuse();
    return root;
  }

  /// Returns the volume (area in 2D) of the solid within a cell.
  double measure(const Vec3& center, double edge, int levels) {
    if (misses(center, edge, levels, 0)) return 0;
    const double d = shape_.distance(center), reach = half_diagonal(edge);
    if (d <= -reach) return std::pow(edge, dimension_);
    if (levels == 0) {
      count_cell();
      return std::pow(edge, dimension_) * fraction_below(d, shape_.normal(center), edge);
    }
    double sum = 0;
    for_each_child(center, edge, [&](const Vec3& c) { sum += measure(c, edge / 2, levels - 1); });
    return sum;
  }

  /// Appends the voxels of a cell that may hold points within `margin` of the solid.
  void collect_voxels(const Vec3& center, double edge, int levels, double margin,
                      std::vector<Voxel>& voxels) {
    if (misses(center, edge, levels, margin)) return;
    if (levels == 0) {
      count_cell();
      voxels.push_back({center, shape_.distance(center) < -half_diagonal(edge)});
      return;
    }
    for_each_child(center, edge,
                   [&](const Vec3& c) { collect_voxels(c, edge / 2, levels - 1, margin, voxels); });
  }

 private:
  [[noreturn]] static void refuse() {
    throw InputError("", "the solid needs more than " + std::to_string(max_boundary_cells) +
                             " voxels; choose a larger voxel size or a smaller solid");
  }

  /// Returns whether no point of a cell is within `margin` of the solid. Outside the solid's bounds
  /// the bounds decide, because distances far from the solid may be too large (those of a sampled
  /// grid beyond its box, for example).
  bool misses(const Vec3& center, double edge, int levels, double margin) const {
    const Vec3 middle = (bounds_.min + bounds_.max) / 2, half = (bounds_.max - bounds_.min) / 2;
    bool near = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == 1 && dimension_ == 2) continue;
      const double away = std::abs(center[axis] - middle[axis]) - half[axis];
      if (away >= edge / 2 + margin) return true;
      near = near && away <= 0;
    }
    return (near || levels == 0) && shape_.distance(center) >= half_diagonal(edge) + margin;
  }

  void count_cell() {
    check_stop_();
    if (++cells_ > max_boundary_cells) refuse();
  }

  double half_diagonal(double edge) const { return edge / 2 * std::sqrt(dimension_); }

  /// Returns the fraction of a cell below a plane at signed distance -d from its centre. The
  /// fraction is taken to grow linearly between the first and the last corner. This is not exact
  /// for a single tilted cut, but has no bias over the many cells that a face cuts at all heights.
  static double fraction_below(double d, const Vec3& normal, double edge) {
    return std::clamp(0.5 - d / (edge * normal.cwiseAbs().sum()), 0.0, 1.0);
  }

  template <class Visit>
  void for_each_child(const Vec3& center, double edge, Visit visit) const {
    const double shift = edge / 4;
    for (int child = 0; child < 8; ++child) {
      if (dimension_ == 2 && (child & 2)) continue;
      Vec3 c = center;
      for (int axis = 0; axis < 3; ++axis)
        if (axis != 1 || dimension_ == 3) c[axis] += (child >> axis & 1) ? shift : -shift;
      visit(c);
    }
  }

  const geometry::LevelSet& shape_;
  const geometry::Bounds bounds_;
  const int dimension_;
  StopCheck check_stop_;
  std::size_t cells_ = 0;
};

}  // namespace

std::vector<Voxel> voxelize(const geometry::LevelSet& shape, int dimension, double edge,
                            double margin, const StopRequest& stop, const Vec3& shift) {
  std::vector<Voxel> voxels;
  Subdivision cut(shape, dimension, stop);
  const auto [center, levels] = cut.root(edge, margin, shift);
  cut.collect_voxels(center, std::ldexp(edge, levels), levels, margin, voxels);
  return voxels;
}

std::vector<double> shares_within(const geometry::LevelSet& shape, int dimension, double edge,
                                  const std::vector<Voxel>& voxels, const StopRequest& stop) {
  const int levels = dimension == 2 ? 2 : 1;
  Subdivision cut(shape, dimension, stop);
  std::vector<double> shares;
  shares.reserve(voxels.size());
  for (const Voxel& voxel : voxels)
    shares.push_back(
        voxel.inside ? 1.0 : cut.measure(voxel.center, edge, levels) / std::pow(edge, dimension));
  return shares;
}

std::optional<geometry::OrientedBox> scene_box(const geometry::LevelSet& shape, int dimension) {
  std::optional<geometry::OrientedBox> box = shape.oriented_box();
  if (!box || dimension == 3) return box;
  const bool across_plane = std::abs(box->axes(1, 1)) > 1 - 1e-12;
  if (!across_plane || std::abs(box->center.y()) >= box->half.y()) return std::nullopt;
  box->center.y() = 0;
  return box;
}

double measure(const geometry::LevelSet& shape, int dimension, double voxel,
               const StopRequest& stop) {
  require_bounded(shape.bounds(), dimension);
  if (const auto box = scene_box(shape, dimension))
    return dimension == 2 ? 4 * box->half.x() * box->half.z() : 8 * box->half.prod();
  Subdivision cut(shape, dimension, stop);
  auto [center, levels] = cut.root(voxel, 0.0);
  const double edge = std::ldexp(voxel, levels);
  // Small solids, which have few cells, get the finest subdivision of their boundary.
  const int coarse_levels = dimension == 2 ? 12 : 8;
  levels += std::clamp(coarse_levels - levels, 1, 3);
  return cut.measure(center, edge, levels);
}

}  // namespace snowshed::sampling
