// Interface between neighbour lists and the kernel that searches for them: nothing here depends on
// an instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace snowshed::particles {

/// Points by axes, in the order of their cells, m. Kernels read and write several values at a time,
/// so there is memory for `spare` more values behind the last point and behind the neighbours.
template <int D>
struct SearchedPoints {
  static constexpr std::size_t spare = 16;
  const double* coordinate[D];
  double radius, period;  // m; period 0: nothing is repeated along x
};

/// Writes the points of [begin, end) that are nearer to point i than the radius, without i itself,
/// in their order; returns their number.
template <int D>
using NeighbourSearch = std::size_t (*)(const SearchedPoints<D>&, std::uint32_t i,
                                        std::uint32_t begin, std::uint32_t end,
                                        std::uint32_t* neighbours);

}  // namespace snowshed::particles
