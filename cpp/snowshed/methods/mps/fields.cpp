// Fields of the particles of the MPS method.
#include <cmath>

#include "snowshed/methods/field_sources.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::methods::mps {

/// Calls visit(info, view) for each field; view() returns its view.
template <int D>
template <class Visit>
void SolverImpl<D>::visit_fields(Visit visit) const {
  const Particles<D>& p = state_.particles;
  const FieldSources show(visit, size(), model_.threads);
  show.of_each("position", [&p](std::size_t i) { return embed(p.position[i]); });
  show.of_each("velocity", [&p](std::size_t i) { return embed(p.velocity[i]); });
  show.column("mass", p.mass);
  show.of_each("density", [this, &p](std::size_t i) {
    return model_.settings().density * p.relative_density[i];
  });
  show.column("number_density", p.relative_density);
  show.column("pressure", p.pressure);
  show.column("shear_rate", p.shear_rate);
  show.column("apparent_viscosity", p.viscosity);
  show.computed("particle_kind", [&] {
    std::vector<std::uint8_t> kinds(size());
    for (std::size_t i = 0; i < size(); ++i) kinds[i] = std::uint8_t(p.kind[i]);
    return kinds;
  });
  show.column("id", p.id);
  show.column("event", p.event);
}

template <int D>
std::vector<particles::FieldInfo> SolverImpl<D>::fields() const {
  return list_fields([this](const auto& visit) { visit_fields(visit); });
}

template <int D>
particles::FieldView SolverImpl<D>::field(const std::string& name) const {
  return find_field(name, [this](const auto& visit) { visit_fields(visit); });
}

template <int D>
ParticleState SolverImpl<D>::state() const {
  const Particles<D>& p = state_.particles;
  ParticleState s;
  for (const std::uint32_t i : order_by_id()) {
    s.positions.push_back(embed(p.position[i]));
    s.velocities.push_back(embed(p.velocity[i]));
    s.masses.push_back(p.mass[i]);
    s.densities.push_back(model_.settings().density);
    s.ids.push_back(p.id[i]);
    s.events.push_back(p.event[i]);
  }
  return s;
}

template <int D>
NamedEnergies SolverImpl<D>::energies() const {
  if (!model_.options.energy) return named_energies(EnergyBalance{});
  EnergyBalance e = state_.energy;
  const EnergyBalance now = stored_energy(model_, state_.particles);
  e.kinetic = now.kinetic;
  e.gravitational = now.gravitational;
  return named_energies(e);
}

template <int D>
MotionSummary SolverImpl<D>::motion(double limit) const {
  const Particles<D>& p = state_.particles;
  return motion_of(
      size(), limit, [&p](std::size_t i) { return p.mass[i]; },
      [&p](std::size_t i) { return p.velocity[i].squaredNorm(); });
}

template <int D>
std::size_t SolverImpl<D>::bytes() const {
  const Workspace<D>& w = workspace_;
  const Neighbourhood<D>& near = w.near;
  std::size_t total = near.cells.bytes() + near.lists.bytes() + near.contacts.bytes() +
                      w.pressure.multigrid.bytes() + w.viscosity.multigrid.bytes() +
                      w.walls.bytes();
  for (const auto* particles : {&state_.particles, &w.next.particles, &w.start.particles, &w.spare})
    particles->for_each_array([&](const char*, const auto& array) { total += bytes_of(array); });
  return total +
         bytes_of(near.weight, near.slope, near.isotropic_weight, near.snow_slope, near.moments,
                  near.correction, near.weight_correction, near.asymmetry,
                  near.divergence_velocity) +
         bytes_of(w.rates.pair_rate, w.rates.correction, w.viscosity.coupling, w.viscosity.block,
                  w.viscosity.inverse_block, w.rates.gradient, w.spacing.concentration,
                  w.pressure.sum, w.spacing.impulse_share, w.pressure.base, w.pressure.diagonal,
                  w.pressure.source, w.pressure.values, w.cg.r, w.cg.z, w.cg.p, w.cg.q);
}

template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
