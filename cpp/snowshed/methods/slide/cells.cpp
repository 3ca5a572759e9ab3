#include "snowshed/methods/slide/cells.hpp"

#include <algorithm>

#include "snowshed/methods/slide/kernel_api.hpp"

namespace snowshed::methods::slide {

void CellLists::reserve(std::size_t particles, const Terrain& terrain) {
  begin_.reserve((std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2) + 2);
  order_.reserve(particles);
  for (auto* array : {&x_, &y_, &z_, &mass_}) array->reserve(particles + sorted_padding);
}

void CellLists::find_rectangle(const AlignedVector<std::int32_t>& column,
                               const AlignedVector<std::int32_t>& row) {
  std::int32_t low[2] = {0, 0}, high[2] = {-1, -1};
  if (!column.empty()) {
    const auto count = std::ptrdiff_t(column.size());
    chosen_kernels().bounds(column.data(), count, low[0], high[0]);
    chosen_kernels().bounds(row.data(), count, low[1], high[1]);
  }
  first_column_ = low[0] - 1;
  first_row_ = low[1] - 1;
  columns_ = high[0] - low[0] + 3;
  rows_ = high[1] - low[1] + 3;
}

void CellLists::update(const AlignedVector<std::int32_t>& column,
                       const AlignedVector<std::int32_t>& row) {
  find_rectangle(column, row);
  const std::size_t n = column.size(), cells = std::size_t(columns_) * std::size_t(rows_);
  // A stable counting sort. During the count the number of particles in cell c is stored at c + 2.
  // During the ordering the begin of cell c is stored at c + 1, where it grows to the end of the
  // cell.
  begin_.assign(cells + 2, 0);
  const auto cell_of = [&](std::size_t i) {
    return std::size_t(row[i] - first_row_) * std::size_t(columns_) +
           std::size_t(column[i] - first_column_);
  };
  for (std::size_t i = 0; i < n; ++i) ++begin_[cell_of(i) + 2];
  for (std::size_t c = 2; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  order_.resize(n);
  for (std::size_t i = 0; i < n; ++i) order_[begin_[cell_of(i) + 1]++] = std::uint32_t(i);

  for (auto* array : {&x_, &y_, &z_, &mass_}) {
    array->resize(n + sorted_padding);
    std::fill(array->end() - std::ptrdiff_t(sorted_padding), array->end(), 0.0);
  }
}

}  // namespace snowshed::methods::slide
