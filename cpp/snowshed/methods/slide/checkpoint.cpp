// Saving and restoring a slide. The workspace follows from the state, so any time is a safe point.
#include <algorithm>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/slide/solver_impl.hpp"

namespace snowshed {

void SlideSolver::save(BinaryWriter& out) const {
  require_sound();
  state_.particles.for_each_array([&out](const char* name, const auto& array) {
    out.add(std::string("particles/") + name, array);
  });
  out.add("bonds/first", state_.bonds.first);
  out.add("bonds/second", state_.bonds.second);
  out.add("bonds/rest_length", state_.bonds.rest_length);
  out.add("peaks/thickness", state_.peaks.thickness);
  out.add("peaks/speed", state_.peaks.speed);
  out.add("erodible", state_.erodible);
  const MassBalance& b = state_.balance;
  out.add("clock",
          std::vector<double>{state_.time, state_.dt, state_.kinetic_energy, state_.peak_kinetic,
                              b.released, b.entrained, b.left, state_.step});
  std::vector<double> energies;
  SlideEnergy::for_each_sum(state_.energy, [&](double sum) { energies.push_back(sum); });
  out.add("energy", std::move(energies));
  const StepCounters& c = state_.counters;
  out.add("counters", std::vector<std::int64_t>{
                          c.steps, c.sorts, c.particle_updates, state_.bonds_made, b.particles_left,
                          std::int64_t(state_.stopped), std::int64_t(state_.next_id)});
}

namespace {

void check_places(const BinaryReader& in, const Terrain& terrain, const SlideParticles& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const GridPlace place = terrain.place(p.x[i], p.y[i]);
    if (!place.inside() || !terrain.known(place))
      throw InputError(in.path().string(), "a particle lies outside of the terrain");
    if (!(p.mass[i] > 0)) throw InputError(in.path().string(), "a particle has no mass");
  }
}

void check_bonds(const BinaryReader& in, const Bonds& bonds, std::size_t particles) {
  for (std::size_t b = 0; b < bonds.size(); ++b)
    if (bonds.first[b] >= particles || bonds.second[b] >= particles ||
        bonds.first[b] == bonds.second[b] || !(bonds.rest_length[b] > 0))
      throw InputError(in.path().string(), "a bond is not sound");
}

}  // namespace

void SlideSolver::load(const BinaryReader& in) {
  SlideState next(model_);
  const std::size_t n = in.view<double>("particles/mass").size;
  next.particles.resize(n);
  next.particles.for_each_array([&in, n](const char* name, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    const auto values = in.get<Value>(std::string("particles/") + name, n);
    std::copy(values.begin(), values.end(), array.begin());
  });
  check_places(in, model_.terrain, next.particles);
  next.bonds.first = in.get<std::uint32_t>("bonds/first");
  next.bonds.second = in.get<std::uint32_t>("bonds/second", next.bonds.first.size());
  next.bonds.rest_length = in.get<double>("bonds/rest_length", next.bonds.first.size());
  check_bonds(in, next.bonds, n);
  next.peaks.thickness = in.get<double>("peaks/thickness", next.peaks.thickness.size());
  next.peaks.speed = in.get<double>("peaks/speed", next.peaks.speed.size());
  next.erodible = in.get<double>("erodible", next.erodible.size());
  const auto clock = in.get<double>("clock", 8);
  next.time = clock[0];
  next.dt = clock[1];
  next.kinetic_energy = clock[2];
  next.peak_kinetic = clock[3];
  const auto energies = in.get<double>("energy", 8);
  std::size_t sum = 0;
  SlideEnergy::for_each_sum(next.energy, [&](double& value) { value = energies[sum++]; });
  const auto counts = in.get<std::int64_t>("counters", 7);
  next.step = clock[7];
  next.balance = {clock[4], clock[5], clock[6], counts[4]};
  if (!(next.step > 0)) throw InputError(in.path().string(), "the time step is not sound");
  next.counters.smallest_dt = next.step;
  next.counters.steps = counts[0];
  next.counters.sorts = counts[1];
  next.counters.particle_updates = counts[2];
  next.bonds_made = counts[3];
  next.stopped = counts[5] != 0;
  next.next_id = std::uint32_t(counts[6]);
  SlideWork work;
  refresh(model_, next, work);
  state_ = std::move(next);
  work_ = std::move(work);
  order_known_ = false;
  broken_ = false;
}

}  // namespace snowshed
