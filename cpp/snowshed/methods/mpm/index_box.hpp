// Boxes of nodes or blocks of a grid.
#pragma once

#include <cstddef>
#include <tuple>

namespace snowshed::methods::mpm {

/// Calls f(index) for all indices in [begin, end) along each direction. The last direction changes
/// fastest. An index is an array of two or three integers.
template <class Index, class F>
void for_each_index(const Index& begin, const Index& end, F f) {
  constexpr int dimension = int(std::tuple_size<Index>::value);
  static_assert(dimension == 2 || dimension == 3);
  Index at{};
  for (at[0] = begin[0]; at[0] < end[0]; ++at[0])
    for (at[1] = begin[1]; at[1] < end[1]; ++at[1]) {
      if constexpr (dimension == 2)
        f(at);
      else
        for (at[2] = begin[2]; at[2] < end[2]; ++at[2]) f(at);
    }
}

}  // namespace snowshed::methods::mpm
