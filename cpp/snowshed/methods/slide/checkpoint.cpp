// Saving and restoring a slide. The workspace follows from the state, so any time is a safe point.
#include <string>
#include <type_traits>

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

void check_places(const BinaryReader& in, const Terrain& terrain) {
  const auto x = in.view<double>("particles/x"), y = in.view<double>("particles/y"),
             mass = in.view<double>("particles/mass");
  for (std::size_t i = 0; i < mass.size; ++i) {
    const GridPlace place = terrain.place(x[i], y[i]);
    if (!place.inside() || !terrain.known(place))
      throw InputError(in.path().string(), "a particle lies outside of the terrain");
    if (!(mass[i] > 0)) throw InputError(in.path().string(), "a particle has no mass");
  }
}

void check_bonds(const BinaryReader& in, std::size_t particles) {
  const auto first = in.view<std::uint32_t>("bonds/first"),
             second = in.view<std::uint32_t>("bonds/second");
  const auto length = in.view<double>("bonds/rest_length");
  for (std::size_t b = 0; b < first.size; ++b)
    if (first[b] >= particles || second[b] >= particles || first[b] == second[b] ||
        !(length[b] > 0))
      throw InputError(in.path().string(), "a bond is not sound");
}

/// Takes over an array whose length has been checked.
template <class Array>
void copy_array(const BinaryReader& in, const std::string& name, Array& array) {
  const auto values = in.view<typename Array::value_type>(name);
  array.assign(values.begin(), values.end());
}

}  // namespace

void SlideSolver::check(const BinaryReader& in) const {
  const std::size_t n = in.view<double>("particles/mass").size;
  state_.particles.for_each_array([&in, n](const char* name, const auto& array) {
    using Value = typename std::decay_t<decltype(array)>::value_type;
    in.view<Value>(std::string("particles/") + name, n);
  });
  check_places(in, model_.terrain);
  const std::size_t bonds = in.view<std::uint32_t>("bonds/first").size;
  in.view<std::uint32_t>("bonds/second", bonds);
  in.view<double>("bonds/rest_length", bonds);
  check_bonds(in, n);
  in.view<double>("peaks/thickness", state_.peaks.thickness.size());
  in.view<double>("peaks/speed", state_.peaks.speed.size());
  in.view<double>("erodible", state_.erodible.size());
  in.view<double>("clock", 8);
  in.view<double>("energy", 8);
  in.view<std::int64_t>("counters", 7);
  if (!(in.view<double>("clock")[7] > 0))
    throw InputError(in.path().string(), "the time step is not sound");
}

void SlideSolver::load(const BinaryReader& in) {
  check(in);
  SlideState next(model_);
  next.particles.for_each_array([&in](const char* name, auto& array) {
    copy_array(in, std::string("particles/") + name, array);
  });
  copy_array(in, "bonds/first", next.bonds.first);
  copy_array(in, "bonds/second", next.bonds.second);
  copy_array(in, "bonds/rest_length", next.bonds.rest_length);
  copy_array(in, "peaks/thickness", next.peaks.thickness);
  copy_array(in, "peaks/speed", next.peaks.speed);
  copy_array(in, "erodible", next.erodible);
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
