#include "snowshed/particles/neighbour_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"

namespace snowshed::particles {
namespace {

constexpr std::size_t cells_in_part = 64;
constexpr std::ptrdiff_t points_in_part = 256;

}  // namespace

template <int D>
void NeighbourLists<D>::Part::make_room(std::size_t more) {
  const std::size_t needed = size + more + SearchedPoints<D>::spare;
  if (index.size() < needed) index.resize(2 * needed);
}

/// Finds the neighbours of the points of some cells; `first_` gets the lengths of their lists.
template <int D>
void NeighbourLists<D>::find(const SearchedPoints<D>& points, const CellOrder<D>& cells,
                             NeighbourSearch<D> search, std::size_t first_cell,
                             std::size_t last_cell, Part& part) {
  part.size = 0;
  typename CellOrder<D>::Range rows[CellOrder<D>::max_rows];
  for (std::size_t cell = first_cell; cell < last_cell; ++cell) {
    const int count = cells.rows_around(cell, rows);
    std::size_t candidates = 0;
    for (int r = 0; r < count; ++r) candidates += rows[r].end - rows[r].begin;
    for (std::uint32_t i = cells.begin(cell); i < cells.end(cell); ++i) {
      part.make_room(candidates);
      const std::size_t before = part.size;
      for (int r = 0; r < count; ++r)
        part.size += search(points, i, rows[r].begin, rows[r].end, part.index.data() + part.size);
      first_[i + 1] = std::uint32_t(part.size - before);
    }
  }
}

/// Stores the neighbours of the points of some cells, with their separations.
template <int D>
void NeighbourLists<D>::keep(const SearchedPoints<D>& points, const CellOrder<D>& cells,
                             std::size_t first_cell, std::size_t last_cell, const Part& part) {
  const std::uint32_t first = cells.begin(first_cell), last = cells.end(last_cell - 1);
  std::copy_n(part.index.data(), part.size, index_.data() + first_[first]);
  for (int d = 0; d < D; ++d)
    for (std::uint32_t i = first; i < last; ++i)
      for (std::uint32_t e = first_[i]; e < first_[i + 1]; ++e) {
        double difference = coordinate_[d][index_[e]] - coordinate_[d][i];
        if (d == 0 && points.period > 0)
          difference -= points.period * std::nearbyint(difference / points.period);
        offset_[d][e] = float(difference);
      }
}

template <int D>
void NeighbourLists<D>::update(const AlignedVector<VecD<D>>& points, const CellOrder<D>& cells,
                               double radius, double period, NeighbourSearch<D> search,
                               int threads) {
  const std::size_t n = points.size(), parts = (cells.cells() + cells_in_part - 1) / cells_in_part;
  SearchedPoints<D> searched{{}, radius, period};
  for (int d = 0; d < D; ++d) {
    coordinate_[d].resize(n + SearchedPoints<D>::spare);
    for (std::size_t i = 0; i < n; ++i) coordinate_[d][i] = points[i][d];
    searched.coordinate[d] = coordinate_[d].data();
  }
  first_.assign(n + 1, 0);
  parts_.resize(std::max(parts, parts_.size()));
  const auto for_each_part = [&](const auto& act) {
    parallel_for_dynamic(std::ptrdiff_t(parts), threads, 1, [&](std::ptrdiff_t p) {
      const std::size_t begin = std::size_t(p) * cells_in_part;
      act(begin, std::min(cells.cells(), begin + cells_in_part), parts_[std::size_t(p)]);
    });
  };
  for_each_part([&](std::size_t begin, std::size_t end, Part& part) {
    find(searched, cells, search, begin, end, part);
  });
  std::size_t total = 0;
  for (std::size_t p = 0; p < parts; ++p) total += parts_[p].size;
  if (total >= std::numeric_limits<std::uint32_t>::max())
    throw SimulationError(std::to_string(total) + " pairs of neighbours are too many");
  for (std::size_t i = 0; i < n; ++i) first_[i + 1] += first_[i];
  index_.resize(total);
  for (auto& axis : offset_) axis.resize(total);
  for_each_part([&](std::size_t begin, std::size_t end, const Part& part) {
    keep(searched, cells, begin, end, part);
  });
}

template <int D>
void NeighbourLists<D>::find_mirrors(int threads) {
  mirror_.resize(pairs());
  parallel_pieces(std::ptrdiff_t(size()), threads, points_in_part,
                  [&](std::ptrdiff_t first, std::ptrdiff_t last) {
                    for (std::uint32_t i = std::uint32_t(first); i < std::uint32_t(last); ++i)
                      for (std::uint32_t e = begin(i); e < end(i); ++e) {
                        const std::uint32_t j = index_[e];
                        const auto row = index_.begin();
                        const auto place = std::find(row + begin(j), row + end(j), i);
                        mirror_[e] = std::uint32_t(place - row);
                      }
                  });
}

template <int D>
std::size_t NeighbourLists<D>::bytes() const {
  std::size_t total = first_.capacity() * sizeof(std::uint32_t) +
                      (index_.capacity() + mirror_.capacity()) * sizeof(std::uint32_t);
  for (int d = 0; d < D; ++d)
    total += offset_[d].capacity() * sizeof(float) + coordinate_[d].capacity() * sizeof(double);
  for (const Part& part : parts_) total += part.index.capacity() * sizeof(std::uint32_t);
  return total;
}

template class NeighbourLists<2>;
template class NeighbourLists<3>;

}  // namespace snowshed::particles
