// Saving and restoring a slide. The workspace follows from the state, so any time is a safe point.
#include <cmath>
#include <string>

#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/slide/solver_impl.hpp"

namespace snowshed::methods::slide {
namespace {

template <class Archive, class State>
void visit_state(Archive& archive, State& s) {
  const std::size_t particles = archive.size("particles/mass", s.particles.mass);
  s.particles.for_each_array([&](const char* name, auto& array) {
    archive.array(std::string("particles/") + name, array, particles);
  });
  const std::size_t bonds = archive.size("bonds/first", s.bonds.first);
  archive.array("bonds/first", s.bonds.first, bonds);
  archive.array("bonds/second", s.bonds.second, bonds);
  archive.array("bonds/rest_length", s.bonds.rest_length, bonds);
  archive.array("peaks/thickness", s.peaks.thickness, s.peaks.thickness.size());
  archive.array("peaks/speed", s.peaks.speed, s.peaks.speed.size());
  archive.array("erodible", s.erodible, s.erodible.size());
  archive.optional_array("late_releases", s.late, s.late.size());
  auto& b = s.balance;
  archive.numbers("clock", s.time, s.dt, s.kinetic_energy, s.peak_kinetic, b.released, b.entrained,
                  b.left_terrain, s.step);
  auto& e = s.energy;
  archive.numbers("energy", e.coulomb, e.turbulent, e.resistance, e.viscosity, e.entrainment,
                  e.broken, e.left_terrain, e.added);
  archive.optional_array("over_dams", s.over_dams, s.over_dams.size());
  archive.optional_array("forest", s.forest, s.forest.size());
  archive.optional_numbers("later_sums", b.secondary, b.inflow, b.detrained, e.detrainment, e.dams);
  if (s.ground) {
    auto& g = *s.ground;
    archive.array("ground/rise", g.rise, g.rise.size());
    archive.array("ground/waiting", g.waiting, g.waiting.size());
    archive.array("ground/stopped", g.stopped, g.stopped.size());
    archive.numbers("ground/sums", b.stopped, e.ground);
    archive.counts("ground/bonds", s.bonds_in_ground);
  }
  auto& c = s.counters;
  archive.counts("counters", c.steps, s.sorts, c.particle_updates, s.bonds_made, b.particles_left,
                 s.stopped, s.next_id);
}

void check_positions(const StateReader& archive, const Particles& p, const Terrain& terrain) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const geometry::CellPosition position = terrain.cell_position(p.x[i], p.y[i]);
    if (!position.inside() || !terrain.known(position))
      archive.refuse("a particle lies outside of the terrain");
    if (!(p.mass[i] > 0)) archive.refuse("a particle has no mass");
  }
}

void check_bonds(const StateReader& archive, const Bonds& bonds, std::size_t particles) {
  for (std::size_t b = 0; b < bonds.size(); ++b)
    if (bonds.first[b] >= particles || bonds.second[b] >= particles ||
        bonds.first[b] == bonds.second[b] || !(bonds.rest_length[b] > 0))
      archive.refuse("a bond is not sound");
}

void check_later(const StateReader& archive, const State& s) {
  for (const double late : s.late)
    if (late != waiting && late != due && !(late >= 0 && late <= s.time))
      archive.refuse("the time of a release is not sound");
  for (const double rest : s.particles.rest)
    if (!(rest >= 0)) archive.refuse("the time of rest of a particle is not sound");
  const MassBalance& b = s.balance;
  for (const double mass : {b.secondary, b.inflow, b.detrained, b.stopped})
    if (!(mass >= 0 && std::isfinite(mass))) archive.refuse("a mass is not sound");
  for (const double mass : s.over_dams)
    if (!(mass >= 0 && std::isfinite(mass))) archive.refuse("a mass is not sound");
}

State read_state(const io::BinaryReader& in, const Model& model) {
  const StateReader archive(in);
  State next(model);
  visit_state(archive, next);
  if (next.ground) next.ground->derive(model.terrain);
  check_positions(archive, next.particles, model.terrain);
  check_bonds(archive, next.bonds, next.particles.size());
  check_later(archive, next);
  if (!(next.step > 0)) archive.refuse("the time step is not sound");
  next.counters.smallest_dt = next.step;
  return next;
}

}  // namespace

void SolverImpl::save(io::BinaryWriter& out) const {
  soundness_.require();
  StateWriter archive(out);
  visit_state(archive, state_);
}

void SolverImpl::check(const io::BinaryReader& in) const { read_state(in, model_); }

void SolverImpl::load(const io::BinaryReader& in) {
  State next = read_state(in, model_);
  Workspace work;
  refresh(model_, next, work);
  state_ = std::move(next);
  workspace_ = std::move(work);
  order_.forget();
  soundness_ = {};
}

}  // namespace snowshed::methods::slide
