#include "snowshed/methods/slide/cells.hpp"

#include <algorithm>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"

namespace snowshed {

void CellLists::reserve(std::size_t particles, const Terrain& terrain) {
  begin_.reserve((std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2) + 1);
  order_.reserve(particles);
  x_.reserve(particles + sorted_padding);
  y_.reserve(particles + sorted_padding);
  mass_.reserve(particles + sorted_padding);
}

void CellLists::find_rectangle(const AlignedVector<std::int32_t>& column,
                               const AlignedVector<std::int32_t>& row) {
  std::int32_t low[2] = {0, 0}, high[2] = {-1, -1};
  if (!column.empty()) {
    low[0] = high[0] = column[0];
    low[1] = high[1] = row[0];
  }
  for (std::size_t i = 0; i < column.size(); ++i) {
    low[0] = std::min(low[0], column[i]);
    high[0] = std::max(high[0], column[i]);
    low[1] = std::min(low[1], row[i]);
    high[1] = std::max(high[1], row[i]);
  }
  first_column_ = low[0] - 1;
  first_row_ = low[1] - 1;
  columns_ = high[0] - low[0] + 3;
  rows_ = high[1] - low[1] + 3;
}

void CellLists::update(const SlideParticles& particles, const AlignedVector<std::int32_t>& column,
                       const AlignedVector<std::int32_t>& row, int threads) {
  find_rectangle(column, row);
  begin_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  const auto cell_of = [&](std::size_t i) {
    return std::size_t(row[i] - first_row_) * std::size_t(columns_) +
           std::size_t(column[i] - first_column_);
  };
  const std::size_t n = column.size();
  for (std::size_t i = 0; i < n; ++i) ++begin_[cell_of(i) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  order_.resize(n);
  for (std::size_t i = 0; i < n; ++i) order_[begin_[cell_of(i)]++] = std::uint32_t(i);
  // Each cell's begin has moved to its end, which is the begin of the next.
  for (std::size_t c = begin_.size() - 1; c > 0; --c) begin_[c] = begin_[c - 1];
  begin_[0] = 0;

  for (auto* array : {&x_, &y_, &mass_}) {
    array->resize(n + sorted_padding);
    std::fill(array->end() - std::ptrdiff_t(sorted_padding), array->end(), 0.0);
  }
  parallel_pieces(std::ptrdiff_t(n), threads, 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t e = begin; e < end; ++e) {
      const std::uint32_t i = order_[e];
      x_[e] = particles.x[i];
      y_[e] = particles.y[i];
      mass_[e] = particles.mass[i];
    }
  });
}

}  // namespace snowshed
