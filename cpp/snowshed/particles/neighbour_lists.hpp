// Lists of the points within a radius of each point.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/particles/cell_order.hpp"
#include "snowshed/particles/neighbour_search.hpp"

namespace snowshed::particles {

/// Lists of neighbours in one array (compressed rows), each pair in both of its lists, with the
/// separation to the neighbour. Single precision suffices for separations, which are short.
template <int D>
class NeighbourLists {
 public:
  /// Finds the neighbours of points that are stored in the order of their cells (whose `order` is
  /// the identity), within `radius`, which must not be longer than the cells' edges, m. `period` is
  /// that of the cells. Throws SimulationError if there are too many pairs to be numbered.
  void update(const AlignedVector<VecD<D>>& points, const CellOrder<D>& cells, double radius,
              double period, NeighbourSearch<D> search, int threads);

  std::size_t size() const { return first_.size() - 1; }
  std::size_t pairs() const { return index_.size(); }
  /// The entries [begin, end) of a point.
  std::uint32_t begin(std::size_t i) const { return first_[i]; }
  std::uint32_t end(std::size_t i) const { return first_[i + 1]; }
  std::uint32_t neighbour(std::size_t entry) const { return index_[entry]; }

  /// Finds the entry (j, i) for each entry (i, j).
  void find_mirrors(int threads);
  /// The entry of the same pair in the neighbour's list, as `find_mirrors` has found it.
  std::uint32_t mirror(std::size_t entry) const { return mirror_[entry]; }

  const std::uint32_t* first() const { return first_.data(); }
  const std::uint32_t* index() const { return index_.data(); }
  /// From the point to its neighbour, one array for each axis, m.
  const float* offset(int axis) const { return offset_[std::size_t(axis)].data(); }

  /// The separation from the neighbour of an entry, m.
  VecD<D> separation(std::size_t entry) const {
    VecD<D> r;
    for (int d = 0; d < D; ++d) r[d] = double(offset_[std::size_t(d)][entry]);
    return r;
  }

  std::size_t bytes() const;

 private:
  /// Neighbours of some points, before their position in the common array is known.
  struct Part {
    std::vector<std::uint32_t> index;
    std::size_t size = 0;
    void make_room(std::size_t more);
  };
  void find(const SearchedPoints<D>& points, const CellOrder<D>& cells, NeighbourSearch<D> search,
            std::size_t first_cell, std::size_t last_cell, Part& part);
  void keep(const SearchedPoints<D>& points, const CellOrder<D>& cells, std::size_t first_cell,
            std::size_t last_cell, const Part& part);

  std::vector<std::uint32_t> first_{0};
  AlignedVector<std::uint32_t> index_, mirror_;
  std::array<AlignedVector<float>, D> offset_;
  std::vector<Part> parts_;
  std::array<AlignedVector<double>, D> coordinate_;
};

}  // namespace snowshed::particles
