// Constants that the solver derives once from each snow of a run.
#pragma once

#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/elasticity.hpp"
#include "snowshed/material/snow.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/settings.hpp"

namespace snowshed::methods::mpm {

struct Material {
  material::Elasticity<double> elastic;
  double density = 0;                        // kg/m3, initial
  double initial_plastic_strain = 0;         // volumetric; not used for elastic snow
  material::RegularisedCamClay<double> law;  // all zero for elastic snow
  double elastic_time_step = 0;              // s

  Material(const material::Snow&, int dimension, const Settings&);
};

/// Returns the constants for the kernels. Elastic snow has Cam-Clay constants whose yield function
/// is zero everywhere (M = 0, beta = -1/2), so that it can stand beside snow that yields.
/// `softening` is the factor of the crack band (Settings::softening).
template <class T>
MaterialConstants<T> material_constants(const material::Snow&, int dimension, double softening = 1);

}  // namespace snowshed::methods::mpm
