#include "snowshed/methods/mpm/material_constants.hpp"

#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed::mpm {
namespace {

template <class T>
CamClay<T> law_of(const Snow& s, int dimension) {
  return CamClay<T>::from(s.youngs_modulus, s.poissons_ratio, s.critical_state_slope, s.cohesion,
                          s.hardening_factor, dimension);
}

}  // namespace

Material::Material(const Snow& s, int dimension, const Settings& n)
    : elastic(Elasticity<double>::from(s.youngs_modulus, s.poissons_ratio, dimension)),
      density(s.density),
      elastic_time_step(mpm::elastic_time_step(s.youngs_modulus, s.poissons_ratio, s.density,
                                               dimension, n.dx, n.transfer, n.basis)) {
  if (s.model == SnowModel::elastic) return;
  law = law_of<double>(s, dimension);
  initial_plastic_strain = law.initial_plastic_strain(s.preconsolidation_pressure);
}

template <class T>
MaterialConstants<T> material_constants(const Snow& s, int dimension) {
  const CamClay<T> c = law_of<T>(s, dimension);
  MaterialConstants<T> k{c.elastic.lambda, c.elastic.mu, c.elastic.bulk, c.m2,
                         c.beta,           c.xi,         c.hardening,    T(1 / s.density)};
  if (s.model == SnowModel::elastic) {
    k.m2 = 0;
    k.beta = T(-0.5);
  }
  return k;
}

template MaterialConstants<float> material_constants(const Snow&, int);
template MaterialConstants<double> material_constants(const Snow&, int);

}  // namespace snowshed::mpm
