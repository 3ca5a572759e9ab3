// Saving and restoring. The workspace follows from the state, so any time is a safe point.
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed {
namespace {

/// What an element of an array is written as, and how many of them.
template <class T>
struct Stored {
  using Type = T;
  static constexpr std::size_t count = 1;
};
template <int D>
struct Stored<Eigen::Matrix<double, D, 1>> {
  using Type = double;
  static constexpr std::size_t count = D;
};
template <>
struct Stored<MpsKind> {
  using Type = std::uint8_t;
  static constexpr std::size_t count = 1;
};

[[noreturn]] void refuse(const BinaryReader& in, const std::string& why) {
  throw InputError(in.path().string(), why);
}

}  // namespace

template <int D>
void MpsSolver<D>::save(BinaryWriter& out) const {
  state_.particles.for_each_array([&out](const char* name, const auto& array) {
    using Kind = Stored<std::decay_t<decltype(array[0])>>;
    out.add(std::string("particles/") + name,
            reinterpret_cast<const typename Kind::Type*>(array.data()), array.size() * Kind::count);
  });
  const MpsState<D>& s = state_;
  out.add("clock", std::vector<double>{s.time, s.dt, s.counters.smallest_dt,
                                       s.solves.pressure.residual, s.solves.viscosity.residual});
  const EnergyBalance& e = s.energy;
  out.add("energy", std::vector<double>{e.plastic, e.friction, e.sticking, e.transfer, e.added});
  const StepCounters& c = s.counters;
  out.add("counters", std::vector<std::int64_t>{
                          c.steps, c.rejected, c.particle_updates, std::int64_t(s.next_id),
                          s.pressure_iterations, s.viscosity_iterations,
                          s.solves.pressure.iterations, s.solves.viscosity.iterations});
}

template <int D>
MpsState<D> MpsSolver<D>::restored(const BinaryReader& in) const {
  MpsState<D> next;
  MpsParticles<D>& p = next.particles;
  const std::size_t n = in.view<double>("particles/mass").size;
  p.for_each_array([&](const char* name, const auto& array) {
    using Kind = Stored<std::decay_t<decltype(array[0])>>;
    in.view<typename Kind::Type>(std::string("particles/") + name, n * Kind::count);
  });
  p.resize(n);
  p.for_each_array([&](const char* name, auto& array) {
    using Kind = Stored<std::decay_t<decltype(array[0])>>;
    const auto values = in.view<typename Kind::Type>(std::string("particles/") + name);
    std::copy(values.begin(), values.end(), reinterpret_cast<typename Kind::Type*>(array.data()));
  });
  for (std::size_t i = 0; i < n; ++i) {
    if (!p.position[i].allFinite() || !p.velocity[i].allFinite() || !(p.pressure[i] >= 0) ||
        !std::isfinite(p.pressure[i]) || !(p.mass[i] > 0) || !std::isfinite(p.mass[i]))
      refuse(in, "a particle is not sound");
    if (p.kind[i] > MpsKind::dummy_wall) refuse(in, "there is no such kind of particle");
    if (model_.options.period > 0 &&
        !(p.position[i][0] >= 0 && p.position[i][0] <= model_.options.period))
      refuse(in, "a particle lies outside of the period");
  }
  try {
    CellOrder<D>().update(p.position, model_.reach(), model_.options.period);
  } catch (const SimulationError& error) {
    refuse(in, error.what());
  }
  const auto clock = in.get<double>("clock", 5);
  const auto energy = in.get<double>("energy", 5);
  for (const auto* values : {&clock, &energy})
    for (const double value : *values)
      if (!std::isfinite(value)) refuse(in, "the clock is not sound");
  const auto counts = in.get<std::int64_t>("counters", 8);
  for (const std::int64_t count : counts)
    if (count < 0) refuse(in, "a counter is negative");
  if (counts[3] > 0xffffffff) refuse(in, "ids are not sound");
  next.time = clock[0];
  next.dt = clock[1];
  next.solves.pressure = {int(counts[6]), clock[3], true};
  next.solves.viscosity = {int(counts[7]), clock[4], true};
  EnergyBalance& e = next.energy;
  e.plastic = energy[0];
  e.friction = energy[1];
  e.sticking = energy[2];
  e.transfer = energy[3];
  e.added = energy[4];
  next.counters.steps = counts[0];
  next.counters.rejected = counts[1];
  next.counters.particle_updates = counts[2];
  next.counters.smallest_dt = clock[2];
  next.next_id = std::uint32_t(counts[3]);
  next.pressure_iterations = counts[4];
  next.viscosity_iterations = counts[5];
  return next;
}

template <int D>
void MpsSolver<D>::load(const BinaryReader& in) {
  state_ = restored(in);
  order_known_ = false;
}

template <int D>
void MpsSolver<D>::check(const BinaryReader& in) const {
  restored(in);
}

template class MpsSolver<2>;
template class MpsSolver<3>;

}  // namespace snowshed
