// A node at which the snow of two events touches, or has just come off.
#pragma once

#include <cstdint>
#include <tuple>

#include "snowshed/methods/mpm/block_layout.hpp"

namespace snowshed::mpm {

template <class T>
struct FieldContact {
  BlockKey first_key, second_key;  // keys of the two blocks of nodes, in ascending order
  std::int32_t node;
  std::int32_t first, second;  // the blocks' places in the layout
  bool touches;                // otherwise it has come off since, and only friction is due
  T normal[3];                 // from the first field to the second
  T impulse;       // stored normal impulse, N s, that friction has yet to be charged for
  T next_impulse;  // the same after the step being tried

  auto name() const { return std::tie(first_key, second_key, node); }
};

}  // namespace snowshed::mpm
