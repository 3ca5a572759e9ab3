// Pure elasticity. It has the interface of a plastic law without a return mapping, which thus costs
// nothing.
#pragma once

#include "snowshed/material/elasticity.hpp"

SNOWSHED_VARIANT_BEGIN

template <class T>
struct Elastic {
  Elasticity<T> elastic;
  static constexpr bool plastic = false;
};

SNOWSHED_VARIANT_END
