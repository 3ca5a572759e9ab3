#include "snowshed/particles/cell_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "snowshed/core/errors.hpp"

namespace snowshed::particles {
namespace {

/// Largest number of cells along an axis; the product over the axes fits into 64 bits.
template <int D>
constexpr double max_cells_per_axis = D == 2 ? 1e9 : 2e6;

}  // namespace

template <int D>
void CellOrder<D>::number_cells(const Points& points, double edge, double period) {
  VecD<D> low = points[0], high = points[0];
  bool finite = true;
  for (const VecD<D>& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
    finite = finite && x.allFinite();
  }
  if (!finite) throw SimulationError("a particle's position is not finite");
  VecD<D> per_length = VecD<D>::Constant(1 / edge);
  if (periodic_) {
    low[0] = 0;
    high[0] = period;
    per_length[0] = std::floor(period / edge) / period;
  }
  for (int d = 0; d < D; ++d) {
    const double cells = (high[d] - low[d]) * per_length[d];
    if (!(cells < max_cells_per_axis<D>))
      throw SimulationError("particles are " + std::to_string(high[d] - low[d]) +
                            " m apart, which is too far for cells of " + std::to_string(edge) +
                            " m");
    counts_[d] = std::int32_t(cells) + 3;
  }
  if (periodic_) counts_[0] = std::int32_t(std::floor(period / edge)) + 2;
  keys_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Coordinates c;
    for (int d = 0; d < D; ++d)
      c[d] = std::min(std::int32_t((points[i][d] - low[d]) * per_length[d]) + 1, counts_[d] - 2);
    keys_[i] = key(c);
  }
}

/// Radix sort, least digits first.
template <int D>
void CellOrder<D>::sort_keys() {
  constexpr int bits = 11;
  constexpr std::uint64_t digits = 1u << bits;
  const std::size_t n = keys_.size();
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0u);
  sorted_keys_ = keys_;
  sorted_ = std::is_sorted(keys_.begin(), keys_.end());
  if (sorted_) return;
  spare_keys_.resize(n);
  spare_order_.resize(n);
  Coordinates last;
  for (int d = 0; d < D; ++d) last[d] = counts_[d] - 1;
  for (int shift = 0; shift < 64 && (key(last) >> shift) > 0; shift += bits) {
    std::array<std::uint32_t, digits + 1> start{};
    for (const std::uint64_t k : sorted_keys_) ++start[((k >> shift) & (digits - 1)) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t to = start[(sorted_keys_[i] >> shift) & (digits - 1)]++;
      spare_keys_[to] = sorted_keys_[i];
      spare_order_[to] = order_[i];
    }
    sorted_keys_.swap(spare_keys_);
    order_.swap(spare_order_);
  }
}

template <int D>
void CellOrder<D>::list_cells() {
  begin_.clear();
  cell_keys_.clear();
  coordinates_.clear();
  for (std::size_t i = 0; i < sorted_keys_.size(); ++i) {
    if (i > 0 && sorted_keys_[i] == sorted_keys_[i - 1]) continue;
    begin_.push_back(std::uint32_t(i));
    std::uint64_t k = sorted_keys_[i];
    cell_keys_.push_back(k);
    Coordinates c;
    for (int d = 0; d < D; ++d) {
      c[d] = std::int32_t(d + 1 < D ? k % std::uint64_t(counts_[d]) : k);
      k /= std::uint64_t(counts_[d]);
    }
    coordinates_.push_back(c);
  }
  begin_.push_back(std::uint32_t(sorted_keys_.size()));
}

template <int D>
void CellOrder<D>::update(const Points& points, double edge, double period) {
  periodic_ = period > 0;
  if (points.empty()) {
    keys_.clear();
    counts_.fill(3);
  } else {
    number_cells(points, edge, period);
  }
  sort_keys();
  list_cells();
}

template <int D>
typename CellOrder<D>::Range CellOrder<D>::range_of_keys(std::uint64_t first,
                                                         std::uint64_t last) const {
  const auto low = std::lower_bound(cell_keys_.begin(), cell_keys_.end(), first);
  auto high = low;
  while (high != cell_keys_.end() && *high <= last) ++high;
  return {begin_[std::size_t(low - cell_keys_.begin())],
          begin_[std::size_t(high - cell_keys_.begin())]};
}

template <int D>
int CellOrder<D>::rows_around(std::size_t cell, Range* rows) const {
  const Coordinates at = coordinates_[cell];
  int n = 0;
  const auto append = [&](Coordinates c, std::int32_t first, std::int32_t last) {
    c[0] = first;
    const std::uint64_t k = key(c);
    const Range range = range_of_keys(k, k + std::uint64_t(last - first));
    if (range.begin < range.end) rows[n++] = range;
  };
  Coordinates c = at;
  const int depth = D == 3 ? 1 : 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -depth; y <= depth; ++y) {
      c[D - 1] = at[D - 1] + z;
      if constexpr (D == 3) c[1] = at[1] + y;
      append(c, at[0] - 1, at[0] + 1);
      if (!periodic_) continue;
      const std::int32_t last = counts_[0] - 2;
      if (at[0] == 1) append(c, last, last);
      if (at[0] == last) append(c, 1, 1);
    }
  return n;
}

template <int D>
std::size_t CellOrder<D>::bytes() const {
  return (keys_.capacity() + sorted_keys_.capacity() + spare_keys_.capacity() +
          cell_keys_.capacity()) *
             sizeof(std::uint64_t) +
         (order_.capacity() + spare_order_.capacity() + begin_.capacity()) * sizeof(std::uint32_t) +
         coordinates_.capacity() * sizeof(Coordinates);
}

template class CellOrder<2>;
template class CellOrder<3>;

}  // namespace snowshed::particles
