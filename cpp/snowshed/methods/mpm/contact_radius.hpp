// The size of a particle in contacts. A graphics card compiles this file, too.
#pragma once

#include <cmath>

#include "snowshed/material/sym_tensor.hpp"

namespace snowshed::methods::mpm {

/// Largest volume ratio (current over initial) of loose snow that counts in contacts.
inline constexpr double max_expansion = 1.5;

/// Returns the current over the initial volume of a particle, from its elastic strain b - I and its
/// plastic volumetric strain now and at first.
template <int D>
double volume_ratio(const material::Sym<double, D>& be_minus_identity, double plastic,
                    double initial_plastic) {
  return std::exp(material::trace(material::hencky_strain(be_minus_identity)) + plastic -
                  initial_plastic);
}

/// Returns the contact radius (m) of a particle: a share of half its spacing. `volume` (m3, or m2
/// in two dimensions) is its initial one.
template <int D>
double contact_radius(double share, double volume, double ratio) {
  const double expanded = volume * (ratio < max_expansion ? ratio : max_expansion);
  return 0.5 * share * std::pow(expanded, 1.0 / D);
}

}  // namespace snowshed::methods::mpm
