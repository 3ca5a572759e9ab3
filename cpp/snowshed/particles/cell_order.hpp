// Points in the order of the cells that they lie in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::particles {

/// Points in the plane or in space, sorted into square or cubic cells. Only cells that hold points
/// exist, so the memory does not depend on how far the points are spread. Along x the cells of a
/// row are consecutive, and so are their points.
template <int D>
class CellOrder {
 public:
  using Points = AlignedVector<VecD<D>>;
  using Coordinates = std::array<std::int32_t, D>;

  /// Finds the order of the points in cells whose edges are `edge` or longer, m. With a `period` >
  /// 0 the points are repeated along x. The period must then be at least three edges long, and the
  /// x of all points must lie in [0, period). Throws SimulationError if a point is not finite, or
  /// if two points are too far apart for the numbers of cells.
  void update(const Points& points, double edge, double period = 0);

  /// Indices of the points in the order of cells; points of a cell keep their order.
  const std::vector<std::uint32_t>& order() const { return order_; }
  bool is_sorted() const { return sorted_; }

  std::size_t cells() const { return coordinates_.size(); }
  /// The points of a cell, as indices into the order.
  std::uint32_t begin(std::size_t cell) const { return begin_[cell]; }
  std::uint32_t end(std::size_t cell) const { return begin_[cell + 1]; }
  const Coordinates& coordinates(std::size_t cell) const { return coordinates_[cell]; }

  /// Indices [begin, end) into the order.
  struct Range {
    std::uint32_t begin, end;
  };
  /// Ranges for a cell: one for each of the 3^(D-1) rows, and twice as many with a period.
  static constexpr int max_rows = D == 2 ? 6 : 18;
  /// The points of a cell and of all cells around it; returns the number of ranges.
  int rows_around(std::size_t cell, Range* rows) const;

  /// The period in cells along x, or 0 without a period.
  std::int32_t period_cells() const { return periodic_ ? counts_[0] - 2 : 0; }

  std::size_t bytes() const;

 private:
  std::uint64_t key(const Coordinates& c) const {
    std::uint64_t k = std::uint64_t(c[D - 1]);
    for (int d = D - 2; d >= 0; --d) k = k * std::uint64_t(counts_[d]) + std::uint64_t(c[d]);
    return k;
  }
  Range range_of_keys(std::uint64_t first, std::uint64_t last) const;
  void number_cells(const Points& points, double edge, double period);
  void sort_keys();
  void list_cells();

  bool periodic_ = false, sorted_ = true;
  Coordinates counts_{};  // number of cells along each axis, with an empty one at either end
  std::vector<std::uint64_t> keys_, sorted_keys_, spare_keys_, cell_keys_;
  std::vector<std::uint32_t> order_, spare_order_, begin_;
  std::vector<Coordinates> coordinates_;
};

}  // namespace snowshed::particles
