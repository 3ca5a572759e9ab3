#include "snowshed/methods/mps/viscous_stress.hpp"

#include <algorithm>

#include "snowshed/methods/mps/kernel_function.hpp"

namespace snowshed::methods::mps {
namespace {

/// The share of a pair's cell that the drag of a sticky wall represents: half of it if both
/// particles lie in the layer at the wall, because the drag acts over the half of their cells next
/// to the wall.
template <int D>
double share_of_drag(const Model<D>& model, const Neighbourhood<D>& near, std::size_t i,
                     std::size_t j) {
  double most = 0;
  for (const WallContact<D>* a = near.contacts.begin(i); a < near.contacts.end(i); ++a) {
    const WallContact<D>* b = near.contact_with(j, a->obstacle);
    if (!b || !model.is_sticky(*a)) continue;
    const double farther = std::max(a->distance, b->distance) / model.settings().spacing;
    most = std::max(most, 0.5 * share_of_wall(farther, 0));
  }
  return most;
}

template <int D>
Eigen::Matrix<double, D, D> antisymmetric(const std::array<double, D*(D - 1) / 2>& components) {
  Eigen::Matrix<double, D, D> m = Eigen::Matrix<double, D, D>::Zero();
  std::size_t k = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a + 1; b < D; ++b, ++k) {
      m(a, b) = components[k];
      m(b, a) = -components[k];
    }
  return m;
}

/// The components of the antisymmetric part of a matrix.
template <int D>
std::array<double, D*(D - 1) / 2> spin(const Eigen::Matrix<double, D, D>& m) {
  std::array<double, D*(D - 1) / 2> components;
  std::size_t k = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a + 1; b < D; ++b) components[k++] = 0.5 * (m(a, b) - m(b, a));
  return components;
}

}  // namespace

template <int D>
void find_stress_weights(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  work.viscosity.weight = near.isotropic_weight;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    if (near.contacts.begin(i) == near.contacts.end(i)) return;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      work.viscosity.weight[e] *= float(1 - share_of_drag(model, near, i, near.lists.neighbour(e)));
  });
}

template <int D>
void apply_symmetric_stress(const Model<D>& model, Workspace<D>& work, const double* p, double* q) {
  const Neighbourhood<D>& near = work.near;
  ViscousSolve<D>& solve = work.viscosity;
  const std::size_t n = near.lists.size();
  const int threads = model.threads_for(n);
  const auto offsets = near.offsets();
  const double* const block = solve.own_block.data()->data();
  solve.gradient.resize(n);
  solve.spread.resize(n);
  solve.turn.resize(n);
  solve.torque.resize(n);
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_gradients(near.rows(), offsets.data(), work.rates.snow_slope, p,
                                solve.gradient.data()->data(), begin, end);
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
      solve.turn[i] = spin<D>(solve.gradient[i] * work.rates.correction[i]);
  });
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_stresses(near.rows(), offsets.data(), solve.coupling.data(), block, p,
                               solve.turn.data()->data(), q, solve.torque.data()->data(), begin,
                               end);
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
      solve.spread[i] = antisymmetric<D>(solve.torque[i]) * work.rates.correction[i].transpose();
  });
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.spread_torques(near.rows(), offsets.data(), work.rates.snow_slope, block,
                                 solve.spread.data()->data(), q, begin, end);
  });
}

template void find_stress_weights(const Model<2>&, const Particles<2>&, Workspace<2>&);
template void find_stress_weights(const Model<3>&, const Particles<3>&, Workspace<3>&);
template void apply_symmetric_stress(const Model<2>&, Workspace<2>&, const double*, double*);
template void apply_symmetric_stress(const Model<3>&, Workspace<3>&, const double*, double*);

}  // namespace snowshed::methods::mps
