// Saving and restoring. The workspace follows from the state, so any time is a safe point.
#include <cmath>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::methods::mps {
namespace {

template <class Archive, class State>
void visit_state(Archive& archive, State& s) {
  const std::size_t particles = archive.size("particles/mass", s.particles.mass);
  s.particles.for_each_array([&](const char* name, auto& array) {
    archive.array(std::string("particles/") + name, array, particles);
  });
  auto &pressure = s.solves.pressure, &viscosity = s.solves.viscosity;
  archive.numbers("clock", s.time, s.dt, s.counters.smallest_dt, pressure.residual,
                  viscosity.residual);
  auto& e = s.energy;
  archive.numbers("energy", e.plastic, e.friction, e.sticking, e.transfer, e.added);
  auto& c = s.counters;
  archive.counts("counters", c.steps, c.rejected, c.particle_updates, s.next_id,
                 s.pressure_iterations, s.viscosity_iterations, pressure.iterations,
                 viscosity.iterations);
}

template <int D>
void check_particles(const StateReader& archive, const Particles<D>& p, const Model<D>& model) {
  const double period = model.options.period;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.position[i].allFinite() || !p.velocity[i].allFinite() || !(p.pressure[i] >= 0) ||
        !std::isfinite(p.pressure[i]) || !(p.mass[i] > 0) || !std::isfinite(p.mass[i]))
      archive.refuse("a particle is not sound");
    if (p.kind[i] > Kind::dummy_wall) archive.refuse("there is no such kind of particle");
    if (period > 0 && !(p.position[i][0] >= 0 && p.position[i][0] <= period))
      archive.refuse("a particle lies outside of the period");
  }
  try {
    particles::CellOrder<D>().update(p.position, model.reach(), period);
  } catch (const SimulationError& error) {
    archive.refuse(error.what());
  }
}

}  // namespace

template <int D>
void SolverImpl<D>::save(io::BinaryWriter& out) const {
  StateWriter archive(out);
  visit_state(archive, state_);
  if (forces_) forces_->save(out);
}

/// The record of forces. A checkpoint of a run without one has none; the record begins then.
template <int D>
std::optional<ObstacleForces> SolverImpl<D>::read_forces(const io::BinaryReader& in,
                                                         const State<D>& state) const {
  if (!forces_) return std::nullopt;
  ObstacleForces read(model_.options.obstacles, D, model_.settings().spacing);
  if (in.has("forces/obstacles"))
    read.load(in);
  else
    read.begin_balance(momentum_of(state.particles));
  return read;
}

template <int D>
State<D> SolverImpl<D>::read_state(const io::BinaryReader& in) const {
  const StateReader archive(in);
  State<D> next;
  visit_state(archive, next);
  check_particles(archive, next.particles, model_);
  next.solves.pressure.converged = next.solves.viscosity.converged = true;
  return next;
}

template <int D>
void SolverImpl<D>::load(const io::BinaryReader& in) {
  State<D> next = read_state(in);
  forces_ = read_forces(in, next);
  state_ = std::move(next);
  order_.forget();
}

template <int D>
void SolverImpl<D>::check(const io::BinaryReader& in) const {
  read_forces(in, read_state(in));
}

template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
