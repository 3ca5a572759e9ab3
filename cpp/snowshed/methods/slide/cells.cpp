#include "snowshed/methods/slide/cells.hpp"

#include <algorithm>
#include <limits>

#include "snowshed/core/parallel.hpp"

namespace snowshed {

void CellLists::reserve(std::size_t particles, const Terrain& terrain) {
  begin_.reserve((std::size_t(terrain.columns()) + 2) * (std::size_t(terrain.rows()) + 2) + 1);
  order_.reserve(particles);
  x_.reserve(particles);
  y_.reserve(particles);
  mass_.reserve(particles);
}

void CellLists::find_rectangle(const std::vector<GridPlace>& places) {
  int low[2] = {std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  int high[2] = {-1, -1};
  for (const GridPlace& p : places) {
    low[0] = std::min(low[0], p.column);
    high[0] = std::max(high[0], p.column);
    low[1] = std::min(low[1], p.row);
    high[1] = std::max(high[1], p.row);
  }
  if (places.empty()) low[0] = low[1] = 0;
  first_column_ = low[0] - 1;
  first_row_ = low[1] - 1;
  columns_ = high[0] - low[0] + 3;
  rows_ = high[1] - low[1] + 3;
}

void CellLists::update(const SlideParticles& particles, const std::vector<GridPlace>& places,
                       int threads) {
  find_rectangle(places);
  begin_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  const auto cell_of = [this](const GridPlace& p) {
    return std::size_t(p.row - first_row_) * std::size_t(columns_) +
           std::size_t(p.column - first_column_);
  };
  for (const GridPlace& p : places) ++begin_[cell_of(p) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  order_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    order_[begin_[cell_of(places[i])]++] = std::uint32_t(i);
  // Each cell's begin has moved to its end, which is the begin of the next.
  for (std::size_t c = begin_.size() - 1; c > 0; --c) begin_[c] = begin_[c - 1];
  begin_[0] = 0;

  x_.resize(order_.size());
  y_.resize(order_.size());
  mass_.resize(order_.size());
  parallel_pieces(std::ptrdiff_t(order_.size()), threads, 1024,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t e = begin; e < end; ++e) {
                      const std::uint32_t i = order_[e];
                      x_[e] = particles.x[i];
                      y_[e] = particles.y[i];
                      mass_[e] = particles.mass[i];
                    }
                  });
}

}  // namespace snowshed
