// Search for the points near a position.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::particles {

/// Points sorted into cubic cells of a given edge. A hash table finds the cells, so the memory
/// depends on the number of points and not on the volume that they occupy.
class PointGrid {
 public:
  /// Sorts the points, of which there must be fewer than 2^32. `edge` > 0 is in metres. Throws
  /// Stopped on request.
  PointGrid(const std::vector<Vec3>& points, double edge, const StopRequest& stop = {});

  /// Calls visit(index, point) for every point within one cell edge of x and some farther ones.
  template <class Visit>
  void for_each_near(const Vec3& x, Visit visit) const {
    const Cell cell = cell_of(x);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -y_reach_; j <= y_reach_; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const Range& range = table_[slot_of(key({cell.x + i, cell.y + j, cell.z + k}))];
          for (std::uint32_t n = range.begin; n < range.end; ++n)
            visit(sorted_[n].index, sorted_[n].point);
        }
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  struct Entry {
    Vec3 point;
    std::uint32_t index;
  };
  /// The points sorted_[begin, end) of the cell with this key. Empty slots have begin == end.
  struct Range {
    std::uint64_t key = 0;
    std::uint32_t begin = 0, end = 0;
  };

  Cell cell_of(const Vec3& x) const;

  static std::uint64_t key(const Cell& cell) {
    // 21 bits for each index. Cells 2^21 apart share a list, which only costs time.
    const auto bits = [](std::int64_t i) { return static_cast<std::uint64_t>(i) & 0x1fffff; };
    return bits(cell.x) << 42 | bits(cell.y) << 21 | bits(cell.z);
  }

  /// Returns the slot that holds the key, or the empty slot for it. Cells along z start in
  /// neighbouring slots because they are looked up together.
  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = (((key >> 21) * 0x9e3779b97f4a7c15u >> 20) + key) & mask;
    while (table_[slot].begin != table_[slot].end && table_[slot].key != key)
      slot = (slot + 1) & mask;
    return slot;
  }

  double edge_;
  std::int64_t y_reach_;  // 0 if all points lie in the plane y = 0
  std::vector<Entry> sorted_;
  std::vector<Range> table_;  // open addressing; the size is a power of two
};

}  // namespace snowshed::particles
