// The weight function of the MPS method, and its sums on a lattice.
#pragma once

#include <algorithm>
#include <cmath>

namespace snowshed::methods::mps {

/// Constants of Koshizuka and Oka's operators for a regular lattice, in units of the spacing l0.
struct KernelConstants {
  double radius;          // r_e
  double number_density;  // n0, equation (7) of Saito and others (2012)
  double lambda;          // Koshizuka and Oka (1996)
  double filling;         // sum of filling_weight, with the particle's own
};

/// w(r) = r_e/r - 1 within r_e, of Koshizuka and Oka (1996); equation (3) of Saito and others
/// (2012) is not legible.
inline double kernel_weight(double r, double radius) { return r < radius ? radius / r - 1 : 0.0; }

/// Wendland's function (1995, doi:10.1007/BF02123482) of w(r) as above; 1 at r = 0. Its sum over a
/// particle and its neighbours measures the filled part of the space around, in any arrangement.
/// Relative to squares of the same density it is 1.0005 in hexagons and 1.001 to 1.01 in disorder.
/// The sum of w, which is more curved, is 0.993 in hexagons and 1.003 to 1.025 in disorder (2D,
/// radius 2.1). Disordered snow whose sum of w is n0 therefore takes up more space than its
/// lattice.
inline double filling_weight(double w) {
  const double q = 1 / (1 + w), rest = (1 - q) * (1 - q);
  return rest * rest * (1 + 4 * q);
}

/// Depth of the particles of a layer below the free surface, in l0.
constexpr double layer_depth(int layer) { return layer - 0.5; }

/// n0 and lambda of a particle within a square or cubic lattice of spacing 1. A neighbour exactly
/// at the radius weighs nothing.
inline KernelConstants kernel_constants(int dimension, double radius) {
  const int reach = int(std::ceil(radius));
  double n = 0, moment = 0, filling = 1;
  for (int z = -reach; z <= reach; ++z)
    for (int y = dimension == 3 ? -reach : 0; y <= (dimension == 3 ? reach : 0); ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double r2 = double(x * x + y * y + z * z);
        if (r2 == 0) continue;
        const double w = kernel_weight(std::sqrt(r2), radius);
        n += w;
        moment += w * r2;
        filling += filling_weight(w);
      }
  return {radius, n, moment / n, filling};
}

/// Calls visit(w, z) for the lattice points that a particle of this layer, counted from one, would
/// have beyond the first layer: behind a wall, or above a surface. z is the distance along the
/// normal in l0.
template <class Visit>
void visit_beyond_first_layer(int dimension, const KernelConstants& k, int layer,
                              const Visit& visit) {
  const int reach = int(std::ceil(k.radius)), across = dimension == 3 ? reach : 0;
  for (int z = layer; z <= reach; ++z)
    for (int y = -across; y <= across; ++y)
      for (int x = -reach; x <= reach; ++x)
        visit(kernel_weight(std::sqrt(double(x * x + y * y + z * z)), k.radius), z);
}

/// Share of the second layer of a lattice above a wall: 2 d/(lambda n0) times the sum of w z over
/// the points behind the wall. z is the distance along the normal in l0. The shares of all layers
/// add up to one.
inline double second_layer_share(int dimension, const KernelConstants& k) {
  double sum = 0;
  visit_beyond_first_layer(dimension, k, 2, [&](double w, int z) { sum += w * z; });
  return 2 * dimension / (k.lambda * k.number_density) * sum;
}

/// Fraction of a wall's stress that acts on a particle at a distance, in l0; `second` is that of
/// the second layer. The fractions of the layers of a lattice sum to one.
inline double share_of_wall(double distance, double second) {
  const auto falls = [&](double from, double to) {
    return std::clamp((to - distance) / (to - from), 0.0, 1.0);
  };
  return (1 - 2 * second) * falls(0.75, 1.25) + second * falls(1.75, 2.25);
}

/// The part of the filling that the second layer of a lattice below a surface lacks.
inline double second_layer_deficit(int dimension, const KernelConstants& k) {
  double sum = 0;
  visit_beyond_first_layer(dimension, k, 2,
                           [&](double w, int) { sum += filling_weight(w) / k.filling; });
  return sum;
}

/// The pressure of a particle at the surface of a lattice less that of the missing neighbours, in
/// units of its own; a mean with the weights. The pressure is linear, and zero half a spacing above
/// the particle.
inline double surface_difference(int dimension, const KernelConstants& k) {
  double sum = 0, moment = 0;
  visit_beyond_first_layer(dimension, k, 1, [&](double w, int z) {
    sum += w;
    moment += w * z / layer_depth(1);
  });
  return moment / sum;
}

}  // namespace snowshed::methods::mps
