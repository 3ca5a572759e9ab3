#include "snowshed/methods/mpm/material_constants.hpp"

#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed::methods::mpm {
namespace {

template <class T>
material::RegularisedCamClay<T> law_of(const material::Snow& s, int dimension, double softening) {
  auto law = material::RegularisedCamClay<T>::from(s.youngs_modulus, s.poissons_ratio,
                                                   s.critical_state_slope, s.cohesion,
                                                   s.hardening_factor, dimension);
  law.softening = T(softening);
  law.band_begin = T(law.initial_plastic_strain(s.preconsolidation_pressure));
  return law;
}

}  // namespace

Material::Material(const material::Snow& s, int dimension, const Settings& n)
    : elastic(material::Elasticity<double>::from(s.youngs_modulus, s.poissons_ratio, dimension)),
      density(s.density),
      elastic_time_step(mpm::elastic_time_step(s.youngs_modulus, s.poissons_ratio, s.density,
                                               dimension, n.dx, n.transfer, n.basis)) {
  if (s.model == material::SnowModel::elastic) return;
  law = law_of<double>(s, dimension, n.softening());
  initial_plastic_strain = law.band_begin;
}

template <class T>
MaterialConstants<T> material_constants(const material::Snow& s, int dimension, double softening) {
  const material::RegularisedCamClay<T> c = law_of<T>(s, dimension, softening);
  MaterialConstants<T> k{c.elastic.lambda, c.elastic.mu, c.elastic.bulk, c.m2,
                         c.beta,           c.xi,         c.hardening,    T(1 / s.density),
                         c.softening,      c.band_begin};
  if (s.model == material::SnowModel::elastic) {
    k.m2 = 0;
    k.beta = T(-0.5);
  }
  return k;
}

template MaterialConstants<float> material_constants(const material::Snow&, int, double);
template MaterialConstants<double> material_constants(const material::Snow&, int, double);

}  // namespace snowshed::methods::mpm
