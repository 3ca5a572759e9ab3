// Pure elasticity. It has the interface of a plastic law without a return mapping, which thus costs
// nothing.
#pragma once

#include "snowshed/material/elasticity.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(material)

template <class T>
struct Elastic {
  Elasticity<T> elastic;
  static constexpr bool plastic = false;
};

SNOWSHED_MODULE_VARIANT_END
