// Changes of the snow from outside between steps: adding, replacing, pushing and settling it. A new
// state is built beside the old one, which remains if this fails. Only `add_velocity` changes the
// state in place, after all checks.
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Appends the batches to a state and updates all that depends on them.
template <class T, int D>
void add_to(State<T, D>& state, const Model<T, D>& model,
            const std::vector<ParticleBatch>& batches) {
  state.end_balance(model);
  const bool energy = model.options.energy;
  const double before = energy ? state.energy(model).stored() : 0.0;
  std::vector<BlockKey> blocks = blocks_of_particles(state.layout);
  for (const ParticleBatch& batch : batches) state.append(model, batch, blocks);
  state.find_elastic_limits(model);
  state.arrange(model, std::move(blocks));
  if (energy) state.record_added(model, before);
  state.begin_balance();
}

}  // namespace

template <class T, int D>
void SolverImpl<T, D>::accept(State<T, D> next) noexcept {
  state_ = std::move(next);
  workspace_.tiles_valid = false;
}

template <class T, int D>
void SolverImpl<T, D>::add(const std::vector<ParticleBatch>& batches, const StopRequest&) {
  soundness_.require();
  State<T, D> next = state_;
  add_to(next, model_, batches);
  accept(std::move(next));
}

template <class T, int D>
void SolverImpl<T, D>::replace(const std::vector<ParticleBatch>& batches) {
  soundness_.require();
  State<T, D> next(model_);
  next.totals = state_.totals;
  if (state_.forces) {
    state_.end_balance(model_);
    next.forces = state_.forces;
    next.begin_balance();
  }
  if (model_.options.energy) {
    EnergyBalance& balance = next.totals.energy;
    balance.added -= state_.energy(model_).stored();
    balance.kinetic = balance.gravitational = balance.elastic = 0;
  }
  add_to(next, model_, batches);
  accept(std::move(next));
}

template <class T, int D>
void SolverImpl<T, D>::add_velocity(const std::vector<Vec3>& velocity_changes) {
  soundness_.require();
  const std::vector<std::uint32_t>& at = order_by_id();
  check_velocity_changes(velocity_changes, at.size());
  state_.end_balance(model_);
  // Nothing can fail from here on.
  const double before = model_.options.energy ? state_.kinetic_energy(model_) : 0.0;
  double fastest = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    double v2 = 0;
    const VecD<D> change = section<D>(velocity_changes[k]);
    for (int d = 0; d < D; ++d) {
      T& v = state_.particles.velocity[d][at[k]];
      v += T(change[d]);
      v2 += double(v) * double(v);
    }
    fastest = std::max(fastest, v2);
  }
  state_.totals.speed = std::sqrt(fastest);
  if (model_.options.energy) {
    EnergyBalance& balance = state_.totals.energy;
    balance.kinetic = state_.kinetic_energy(model_);
    balance.added += balance.kinetic - before;
  }
  state_.sleep.wake_all(state_.layout, state_.totals.time);
  state_.begin_balance();
  workspace_.tiles_valid = false;
}

template <class T, int D>
void SolverImpl<T, D>::settle(const std::vector<double>& drops,
                              const std::vector<double>& plastic_changes) {
  soundness_.require();
  const std::vector<std::uint32_t>& at = order_by_id();
  check_count("drops", drops.size(), at.size());
  check_count("plastic changes", plastic_changes.size(), at.size());
  for (std::size_t k = 0; k < at.size(); ++k)
    if (!std::isfinite(drops[k]) || !std::isfinite(plastic_changes[k]))
      throw InputError("settling", "not finite");
  const Settings& n = model_.options.settings;
  const double stored = model_.options.energy ? state_.energy(model_).stored() : 0.0;
  State<T, D> next = state_;
  next.end_balance(model_);
  std::vector<BlockKey> blocks = blocks_of_particles(next.layout);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const std::size_t i = at[k];
    VecD<D> x = position_of(next.particles, i, blocks[i], n.dx, n.basis);
    x[D - 1] -= drops[k];
    blocks[i] = next.put(model_, i, x, field_of(blocks[i]));
    if (next.particles.has_plastic) next.particles.plastic[i] += T(plastic_changes[k]);
  }
  next.arrange(model_, std::move(blocks));
  next.sleep.wake_all(next.layout, next.totals.time);
  next.begin_balance();
  if (model_.options.energy) {
    EnergyBalance& balance = next.totals.energy;
    balance.gravitational = next.gravitational_energy(model_);
    balance.added += balance.stored() - stored;
  }
  accept(std::move(next));
}

template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

}  // namespace snowshed::methods::mpm
