// Copies of C++ vectors as NumPy arrays.
#pragma once

#include <pybind11/numpy.h>

#include <algorithm>
#include <string>
#include <vector>

#include "snowshed/core/vec.hpp"

namespace snowshed {

inline pybind11::array_t<double> rows(const std::vector<Vec3>& vectors) {
  pybind11::array_t<double> a({pybind11::ssize_t(vectors.size()), pybind11::ssize_t(3)});
  auto out = a.mutable_unchecked<2>();
  for (pybind11::ssize_t i = 0; i < a.shape(0); ++i)
    for (int k = 0; k < 3; ++k) out(i, k) = vectors[std::size_t(i)][k];
  return a;
}

template <class To, class From>
pybind11::array_t<To> column(const std::vector<From>& values) {
  pybind11::array_t<To> a(pybind11::ssize_t(values.size()));
  auto out = a.template mutable_unchecked<1>();
  for (pybind11::ssize_t i = 0; i < a.shape(0); ++i) out(i) = To(values[std::size_t(i)]);
  return a;
}

/// Values at the nodes of a grid, row by row from the south.
inline pybind11::array_t<double> map_of(const std::vector<double>& values, int rows, int columns) {
  pybind11::array_t<double> map({pybind11::ssize_t(rows), pybind11::ssize_t(columns)});
  std::copy(values.begin(), values.end(), map.mutable_data());
  return map;
}

/// The columns, by name, of a table whose values lie row by row.
inline pybind11::dict columns_of(const std::vector<std::string>& names,
                                 const std::vector<double>& values) {
  pybind11::dict table;
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<double> entries;
    for (std::size_t i = c; i < values.size(); i += names.size()) entries.push_back(values[i]);
    table[names[c].c_str()] = column<double>(entries);
  }
  return table;
}

}  // namespace snowshed
