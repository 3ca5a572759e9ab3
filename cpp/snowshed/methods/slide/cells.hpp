// Lists of the particles in each cell of the terrain.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

/// The particles in the order of their cells, row by row, within the smallest rectangle of cells
/// that holds them all and a margin of one cell. Within a cell they keep the order of storage.
class CellLists {
 public:
  /// `column` and `row` hold the cell of each particle.
  void update(const AlignedVector<std::int32_t>& column, const AlignedVector<std::int32_t>& row);

  /// Reserves memory for this number of particles anywhere on the terrain.
  void reserve(std::size_t particles, const Terrain& terrain);

  /// The rectangle of cells, its margin included.
  int first_column() const { return first_column_; }
  int first_row() const { return first_row_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// The first entry of a cell, counted from the rectangle's corner; the entries of the following
  /// cells come next, row after row.
  std::uint32_t begin(int column, int row) const {
    return begin_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
  }

  std::size_t size() const { return order_.size(); }
  /// The storage index of an entry's particle.
  std::uint32_t particle(std::size_t entry) const { return order_[entry]; }
  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::uint32_t* begins() const { return begin_.data(); }

  // Arrays for loops over neighbours, in the order of the entries; filled in by `sum_on_nodes`
  // (kernel_api.hpp). Entries beyond the last one are zero.
  double* x() { return x_.data(); }
  double* y() { return y_.data(); }
  double* z() { return z_.data(); }
  double* mass() { return mass_.data(); }
  /// Copies masses that have changed; those of the particles that are `gone` are 0. `gone` may be
  /// empty.
  void copy_masses(const AlignedVector<double>& masses, const std::vector<char>& gone) {
    for (std::size_t e = 0; e < order_.size(); ++e)
      mass_[e] = !gone.empty() && gone[order_[e]] ? 0.0 : masses[order_[e]];
  }

  std::size_t bytes() const {
    return (begin_.capacity() + order_.capacity()) * sizeof(std::uint32_t) +
           (x_.capacity() + y_.capacity() + z_.capacity() + mass_.capacity()) * sizeof(double);
  }

 private:
  void find_rectangle(const AlignedVector<std::int32_t>& column,
                      const AlignedVector<std::int32_t>& row);

  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> begin_, order_;
  AlignedVector<double> x_, y_, z_, mass_;
};

}  // namespace snowshed::methods::slide
