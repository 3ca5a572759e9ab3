#include "snowshed/particles/neighbour_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"

namespace snowshed {
namespace {

constexpr std::size_t cells_in_part = 64;
constexpr std::ptrdiff_t points_in_part = 256;

}  // namespace

template <int D>
void NeighbourLists<D>::Part::make_room(std::size_t more) {
  if (index.size() >= size + more) return;
  const std::size_t room = 2 * (size + more);
  for (auto& axis : offset) axis.resize(room);
  index.resize(room);  // last: its size says what all have room for, also where memory is short
}

/// Appends what the points of some cells find; `first_` gets the lengths of their lists.
template <int D>
void NeighbourLists<D>::find(const AlignedVector<VecD<D>>& points, const CellOrder<D>& cells,
                             double radius, double period, std::size_t first_cell,
                             std::size_t last_cell, Part& part) {
  const double reach2 = radius * radius;
  part.size = 0;
  typename CellOrder<D>::Range rows[CellOrder<D>::most_rows];
  for (std::size_t cell = first_cell; cell < last_cell; ++cell) {
    const int count = cells.rows_around(cell, rows);
    std::size_t candidates = 0;
    for (int r = 0; r < count; ++r) candidates += rows[r].end - rows[r].begin;
    for (std::uint32_t i = cells.begin(cell); i < cells.end(cell); ++i) {
      part.make_room(candidates);
      const std::size_t before = part.size;
      std::size_t n = before;
      std::uint32_t* const index = part.index.data();
      for (int r = 0; r < count; ++r)
        for (std::uint32_t j = rows[r].begin; j < rows[r].end; ++j) {
          double way[D], distance2 = 0;
          for (int d = 0; d < D; ++d) {
            way[d] = coordinate_[d][j] - points[i][d];
            if (d == 0 && period > 0) way[0] -= period * std::nearbyint(way[0] / period);
            distance2 += way[d] * way[d];
          }
          index[n] = j;
          for (int d = 0; d < D; ++d) part.offset[d][n] = float(way[d]);
          n += std::size_t((distance2 < reach2) & (j != i));
        }
      part.size = n;
      first_[i + 1] = std::uint32_t(n - before);
    }
  }
}

template <int D>
void NeighbourLists<D>::update(const AlignedVector<VecD<D>>& points, const CellOrder<D>& cells,
                               double radius, double period, int threads) {
  const std::size_t n = points.size(), parts = (cells.cells() + cells_in_part - 1) / cells_in_part;
  for (int d = 0; d < D; ++d) {
    coordinate_[d].resize(n);
    for (std::size_t i = 0; i < n; ++i) coordinate_[d][i] = points[i][d];
  }
  first_.assign(n + 1, 0);
  parts_.resize(std::max(parts, parts_.size()));
  parallel_for(std::ptrdiff_t(parts), threads, 1, [&](std::ptrdiff_t p) {
    const std::size_t begin = std::size_t(p) * cells_in_part;
    find(points, cells, radius, period, begin, std::min(cells.cells(), begin + cells_in_part),
         parts_[std::size_t(p)]);
  });
  std::size_t total = 0;
  for (std::size_t p = 0; p < parts; ++p) total += parts_[p].size;
  if (total >= std::numeric_limits<std::uint32_t>::max())
    throw SimulationError(std::to_string(total) + " pairs of neighbours are too many");
  for (std::size_t i = 0; i < n; ++i) first_[i + 1] += first_[i];
  index_.resize(total);
  for (auto& axis : offset_) axis.resize(total);
  parallel_for(std::ptrdiff_t(parts), threads, 1, [&](std::ptrdiff_t p) {
    const Part& part = parts_[std::size_t(p)];
    const std::size_t to = first_[cells.begin(std::size_t(p) * cells_in_part)];
    std::copy_n(part.index.data(), part.size, index_.data() + to);
    for (int d = 0; d < D; ++d)
      std::copy_n(part.offset[d].data(), part.size, offset_[d].data() + to);
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
                        const auto found = std::find(row + begin(j), row + end(j), i);
                        mirror_[e] = std::uint32_t(found - row);
                      }
                  });
}

template <int D>
std::size_t NeighbourLists<D>::bytes() const {
  std::size_t total = first_.capacity() * sizeof(std::uint32_t) +
                      (index_.capacity() + mirror_.capacity()) * sizeof(std::uint32_t);
  for (int d = 0; d < D; ++d)
    total += offset_[d].capacity() * sizeof(float) + coordinate_[d].capacity() * sizeof(double);
  for (const Part& part : parts_) total += part.index.capacity() * 4 * (D + 1);
  return total;
}

template class NeighbourLists<2>;
template class NeighbourLists<3>;

}  // namespace snowshed
