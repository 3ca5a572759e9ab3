// Changes of the snow from outside between steps. The new state is built beside the old one.
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::methods::mps {
namespace {

/// The forces assume that each particle has the mass of a full cell. The particles of a body whose
/// volume is not a whole number of cells deviate from this: in total, by up to half a cell. Masses
/// outside 0.5 to 1.5 cells are refused, because they indicate a wrong density or spacing.
void check_mass(double mass, double cell_mass) {
  constexpr double min_ratio = 0.5, max_ratio = 1.5;
  if (mass < min_ratio * cell_mass * (1 - 1e-6) || mass > max_ratio * cell_mass * (1 + 1e-6))
    throw InputError("mass", std::to_string(mass) +
                                 " kg; allowed: 0.5 to 1.5 times the mass of a cell, density "
                                 "times spacing to the power of the dimension (" +
                                 std::to_string(cell_mass) + " kg)");
}

}  // namespace

template <int D>
void SolverImpl<D>::append(State<D>& state, const ParticleBatch& batch) const {
  check_batch(batch, 1);
  const Settings& s = model_.settings();
  Particles<D>& p = state.particles;
  const std::vector<PlacedObstacle> walls = place_obstacles(model_.options.obstacles, state.time);
  const std::size_t old = p.size();
  p.resize(old + batch.positions.size());
  for (std::size_t k = 0; k < batch.positions.size(); ++k) {
    const std::size_t i = old + k;
    if (!batch.positions[k].allFinite()) throw InputError("positions", "not finite");
    check_mass(batch.mass_of(k), model_.particle_mass());
    p.position[i] = section<D>(batch.positions[k]);
    if (model_.options.period > 0)
      p.position[i][0] -=
          model_.options.period * std::floor(p.position[i][0] / model_.options.period);
    p.velocity[i] = section<D>(batch.velocity);
    p.pressure[i] = p.shear_rate[i] = 0;
    p.pressure_acceleration[i].setZero();
    p.viscous_acceleration[i].setZero();
    p.elastic_strain[i].setZero();
    p.elastic_slip[i].setZero();
    p.mass[i] = batch.mass_of(k);
    p.relative_density[i] = 1;
    p.viscosity[i] = model_.rheology.viscosity;
    p.kind[i] = Kind::moving;
    if (s.erosion && s.erodible_thickness > 0)
      for (const PlacedObstacle& wall : walls)
        if (!wall.obstacle->motion && wall.distance(embed(p.position[i])) < s.erodible_thickness)
          p.kind[i] = Kind::erodible;
    if (p.kind[i] == Kind::erodible) p.velocity[i].setZero();
    p.id[i] = state.next_id++;
    p.event[i] = std::uint16_t(batch.event);
  }
}

/// Replaces the state. The balance counts the change of the stored energy as added.
template <int D>
void SolverImpl<D>::accept(State<D> next) {
  particles::CellOrder<D>().update(next.particles.position, model_.reach(), model_.options.period);
  if (model_.options.energy)
    next.energy.added += stored_energy(model_, next.particles).stored() -
                         stored_energy(model_, state_.particles).stored();
  end_balance();
  state_ = std::move(next);
  if (forces_) forces_->begin_balance(momentum_of(state_.particles));
  order_.forget();
}

template <int D>
void SolverImpl<D>::add(const std::vector<ParticleBatch>& batches, const StopRequest&) {
  State<D> next = state_;
  for (const ParticleBatch& batch : batches) append(next, batch);
  accept(std::move(next));
}

template <int D>
void SolverImpl<D>::replace(const std::vector<ParticleBatch>& batches) {
  State<D> next = state_;
  next.particles.resize(0);
  for (const ParticleBatch& batch : batches) append(next, batch);
  accept(std::move(next));
}

template <int D>
void SolverImpl<D>::add_velocity(const std::vector<Vec3>& changes) {
  const std::vector<std::uint32_t>& at = order_by_id();
  check_velocity_changes(changes, at.size());
  State<D> next = state_;
  for (std::size_t k = 0; k < at.size(); ++k)
    if (next.particles.moves(at[k])) next.particles.velocity[at[k]] += section<D>(changes[k]);
  accept(std::move(next));
}

template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
