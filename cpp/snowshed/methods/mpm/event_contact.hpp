// A node at which the snow of two events touches or has just separated.
#pragma once

#include <cstdint>
#include <tuple>

#include "snowshed/methods/mpm/block_layout.hpp"

namespace snowshed::methods::mpm {

template <class T>
struct EventContact {
  BlockKey first_key, second_key;  // keys of the two blocks of nodes, in ascending order
  std::int32_t node;
  std::int32_t first, second;  // indices of the two blocks in the layout
  bool touches;                // if false, the snow has separated and only friction is due
  T normal[3];                 // from the first field to the second
  T impulse;                   // stored normal impulse, N s, for which friction is still due
  T next_impulse;              // the same after the step that is being tried

  auto key() const { return std::tie(first_key, second_key, node); }
  bool operator<(const EventContact& other) const { return key() < other.key(); }
};

}  // namespace snowshed::methods::mpm
