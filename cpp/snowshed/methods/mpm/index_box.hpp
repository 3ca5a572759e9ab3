// Boxes of nodes or blocks of a grid.
#pragma once

#include <cstddef>
#include <tuple>

namespace snowshed::methods::mpm {

/// Calls f(index) for all indices in [begin, end) along each direction. The last direction changes
/// fastest. An index is an array of integers.
template <class Index, class F>
void for_each_index(const Index& begin, const Index& end, F f) {
  constexpr int dimension = int(std::tuple_size<Index>::value);
  for (int d = 0; d < dimension; ++d)
    if (begin[d] >= end[d]) return;
  Index at = begin;
  while (true) {
    f(at);
    int d = dimension - 1;
    while (d >= 0 && ++at[d] == end[d]) {
      at[d] = begin[d];
      --d;
    }
    if (d < 0) return;
  }
}

}  // namespace snowshed::methods::mpm
