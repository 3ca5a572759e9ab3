// The weight function of the MPS method, and what follows from it on a lattice.
#pragma once

#include <cmath>

namespace snowshed {

/// Number of axes over which Koshizuka and Oka's operators are normalised, with the constants of a
/// regular lattice, in units of the spacing l0.
struct KernelConstants {
  double radius;          // r_e
  double number_density;  // n0, equation (7)
  double lambda;          // equation (6)
};

/// w(r) = r_e/r - 1 within r_e, equation (3) of Saito and others (2012).
inline double kernel_weight(double r, double radius) { return r < radius ? radius / r - 1 : 0.0; }

/// n0 and lambda of a particle within a square or cubic lattice of spacing 1. A neighbour exactly
/// at the radius weighs nothing.
inline KernelConstants kernel_constants(int dimension, double radius) {
  const int reach = int(std::ceil(radius));
  double n = 0, moment = 0;
  for (int z = -reach; z <= reach; ++z)
    for (int y = dimension == 3 ? -reach : 0; y <= (dimension == 3 ? reach : 0); ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double r2 = double(x * x + y * y + z * z);
        if (r2 == 0) continue;
        const double w = kernel_weight(std::sqrt(r2), radius);
        n += w;
        moment += w * r2;
      }
  return {radius, n, moment / n};
}

/// Calls visit(w, z) for what the second layer of a lattice would see beyond the layer next to it,
/// where z is the way across in l0: behind a wall, or above a surface.
template <class Visit>
void visit_beyond_second_layer(int dimension, const KernelConstants& k, const Visit& visit) {
  const int reach = int(std::ceil(k.radius)), across = dimension == 3 ? reach : 0;
  for (int z = 2; z <= reach; ++z)
    for (int y = -across; y <= across; ++y)
      for (int x = -reach; x <= reach; ++x)
        visit(kernel_weight(std::sqrt(double(x * x + y * y + z * z)), k.radius), z);
}

/// 2 d/(lambda n0) sum of w z over what is behind a wall, for the second layer of a lattice above
/// it, where z is the way along the normal in l0; for all layers it is one.
inline double second_layer_share(int dimension, const KernelConstants& k) {
  double sum = 0;
  visit_beyond_second_layer(dimension, k, [&](double w, int z) { sum += w * z; });
  return 2 * dimension / (k.lambda * k.number_density) * sum;
}

/// The part of n0 that the second layer of a lattice below a surface lacks.
inline double second_layer_lack(int dimension, const KernelConstants& k) {
  double sum = 0;
  visit_beyond_second_layer(dimension, k, [&](double w, int) { sum += w; });
  return sum / k.number_density;
}

}  // namespace snowshed
