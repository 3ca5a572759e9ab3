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

/// Subtracts from q the change of velocity by the torques of the particles.
template <int D>
void spread_torques(const Model<D>& model, const Workspace<D>& work, double* q) {
  const ViscousSolve<D>& solve = work.viscosity;
  const std::size_t n = work.near.lists.size();
  for_each_piece(n, model.threads_for(n), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.spread_torques(work.near.rows(), solve.far_lever.data(),
                                 solve.lever_sum.data()->data(), solve.own_block.data()->data(),
                                 solve.torque.data()->data(), q, begin, end);
  });
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
void find_levers(const Model<D>& model, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const std::size_t n = near.lists.size();
  ViscousSolve<D>& solve = work.viscosity;
  solve.lever.resize(D * near.lists.pairs());
  solve.far_lever.resize(D * near.lists.pairs());
  solve.lever_sum.resize(n);
  for_each_particle(n, model.threads_for(n), [&](std::size_t i) {
    VecD<D> sum = VecD<D>::Zero();
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const VecD<D> half = 0.5 * double(work.rates.snow_slope[e]) * near.separation(e);
      const VecD<D> lever = work.rates.correction[i].transpose() * half;
      const VecD<D> far = work.rates.correction[near.lists.neighbour(e)].transpose() * half;
      sum += lever;
      for (int d = 0; d < D; ++d) {
        solve.lever[e * D + std::size_t(d)] = float(lever[d]);
        solve.far_lever[e * D + std::size_t(d)] = float(far[d]);
      }
    }
    solve.lever_sum[i] = sum;
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
  solve.turn.resize(n);
  solve.torque.resize(n);
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_turns(near.rows(), solve.lever.data(), p, solve.turn.data()->data(), begin,
                            end);
  });
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_stresses(near.rows(), offsets.data(), solve.coupling.data(), block, p,
                               solve.turn.data()->data(), q, solve.torque.data()->data(), begin,
                               end);
  });
  spread_torques(model, work, q);
}

template <int D>
void add_elastic_force(const Model<D>& model, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  ViscousSolve<D>& solve = work.viscosity;
  const std::size_t n = near.lists.size();
  const int threads = model.threads_for(n);
  const auto offsets = near.offsets();
  solve.residual.resize(n);
  solve.torque.resize(n);
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_tensors(near.rows(), offsets.data(), solve.coupling.data(),
                              solve.own_block.data()->data(), work.rates.elastic.data()->data(),
                              solve.residual.data()->data(), solve.torque.data()->data(), begin,
                              end);
  });
  spread_torques(model, work, solve.residual.data()->data());
  for_each_particle(n, threads, [&](std::size_t i) { solve.right_side[i] -= solve.residual[i]; });
}

template void find_stress_weights(const Model<2>&, const Particles<2>&, Workspace<2>&);
template void find_stress_weights(const Model<3>&, const Particles<3>&, Workspace<3>&);
template void find_levers(const Model<2>&, Workspace<2>&);
template void find_levers(const Model<3>&, Workspace<3>&);
template void add_elastic_force(const Model<2>&, Workspace<2>&);
template void add_elastic_force(const Model<3>&, Workspace<3>&);
template void apply_symmetric_stress(const Model<2>&, Workspace<2>&, const double*, double*);
template void apply_symmetric_stress(const Model<3>&, Workspace<3>&, const double*, double*);

}  // namespace snowshed::methods::mps
