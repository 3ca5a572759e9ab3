// Pure elasticity: the case that leaves plasticity out. It has the shape of a plastic law whose
// return map never does anything, and costs nothing.
#pragma once

#include "snowshed/material/elasticity.hpp"

SNOWSHED_VARIANT_BEGIN

template <class T>
struct Elastic {
  Elasticity<T> elastic;
  static constexpr bool plastic = false;
};

SNOWSHED_VARIANT_END
