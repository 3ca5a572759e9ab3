// What the solver derives, once, of each of a run's snows.
#pragma once

#include "snowshed/material/elasticity.hpp"
#include "snowshed/mpm/kernel_api.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

struct SnowKind {
  Elasticity<double> elastic;
  double density = 0;                 // kg/m3, initial
  double initial_plastic_strain = 0;  // volumetric; elastic snow has none
  double elastic_time_step = 0;       // s

  SnowKind(const Snow&, int dimension, const Numerics&);
};

/// The constants the kernels take. Those of elastic snow are Cam-Clay's with a yield function that
/// is zero everywhere (M = 0, beta = -1/2), so that it may stand beside snow that yields.
template <class T>
SnowConstants<T> snow_constants(const Snow&, int dimension);

}  // namespace snowshed
