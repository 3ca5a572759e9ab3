// Particles in the order of their ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace snowshed::particles {

/// Returns the indices of the particles in ascending order of their ids, by a radix sort in O(n).
std::vector<std::uint32_t> order_by_id(const std::uint32_t* ids, std::size_t count);

}  // namespace snowshed::particles
