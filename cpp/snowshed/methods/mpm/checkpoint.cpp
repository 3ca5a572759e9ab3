// Saving and loading the state of a solver. At safe points the particles and the stored impulses of
// the contacts determine everything on the grid, which is therefore not saved.
#include <string>

#include "snowshed/core/memory.hpp"
#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Contents of a checkpoint about contacts and sleep, besides the particles and the numbers.
template <class T, int D>
struct CheckpointParts {
  std::vector<typename Contacts<T, D>::StoredImpulse> impulses;
  std::vector<typename Sleep<D>::State> sleep;
  std::vector<EventContact<T>> event_contacts;
  std::vector<typename Contacts<T, D>::StoredForce> forces;
};

/// Returns whether a solver with a single snow may lack this array. Solvers with several snows have
/// it.
bool is_of_several_snows(const std::string& name) { return name == "kind" || name == "plastic"; }

template <class Archive, class Particles>
void visit_particles(Archive& archive, Particles& particles, std::size_t materials) {
  const std::size_t n = archive.size("particles/mass", particles.mass);
  particles.for_each_array([&](const char* name, auto& array) {
    const std::string section = std::string("particles/") + name;
    if (materials > 1 && is_of_several_snows(name))
      archive.optional_array(section, array, n);  // without it all particles are of the first snow
    else
      archive.array(section, array, n);
  });
}

template <class T, int D, class Archive, class Layout, class Totals>
void visit_rest(Archive& archive, Layout& layout, CheckpointParts<T, D>& stored, Totals& p,
                const Settings& settings) {
  const std::size_t blocks = archive.size("blocks/keys", layout.particle_blocks);
  archive.array("blocks/keys", layout.particle_blocks, blocks);
  archive.array("blocks/first", layout.first, blocks + 1);
  using Impulse = typename Contacts<T, D>::StoredImpulse;
  archive.columns(stored.impulses, column("pressed/block", &Impulse::block),
                  column("pressed/node", &Impulse::node),
                  column("pressed/obstacle", &Impulse::obstacle),
                  column("pressed/amount", &Impulse::amount));
  archive.packed("sleep", stored.sleep, blocks, [](auto& s, const auto& number) {
    number(s.asleep);
    number(s.since);
    number(s.samples);
    number(s.halfway);
    for (int d = 0; d < D; ++d) number(s.sum[d]);
    for (int d = 0; d < D; ++d) number(s.first_half[d]);
  });
  auto& e = p.energy;
  auto& c = p.counters;
  archive.numbers("energy", e.kinetic, e.gravitational, e.elastic, e.plastic, e.friction,
                  e.sticking, e.impact, e.transfer, e.sleep, e.added);
  archive.numbers("clock", p.time, p.dt, p.speed, c.smallest_dt, p.stress_power);
  archive.counts("counters", c.steps, c.rejected, p.sorts, c.particle_updates, p.slept_updates,
                 p.next_id);
  if (settings.fields == Fields::events) {
    using Contact = EventContact<T>;
    archive.columns(stored.event_contacts, column("met/first", &Contact::first_key),
                    column("met/second", &Contact::second_key), column("met/node", &Contact::node),
                    column("met/amount", &Contact::next_impulse));
  }
  if (settings.damps_over_length()) {
    archive.numbers("damping", p.undamped_time, e.damping);
    archive.counts("damping_steps", p.undamped_steps);
  }
}

/// The record of forces. The obstacles' part of it is saved by `ObstacleForces`.
template <class T, int D, class Archive, class Record>
void visit_forces(Archive& archive, CheckpointParts<T, D>& stored, Record& record) {
  using Force = typename Contacts<T, D>::StoredForce;
  archive.columns(stored.forces, column("forces/block", &Force::block),
                  column("forces/node", &Force::node), column("forces/obstacle", &Force::obstacle),
                  column("forces/sum", &Force::sum), column("forces/mean", &Force::mean),
                  column("forces/age", &Force::age));
  archive.packed(
      "forces/held", record.held, record.forces.names().size(),
      [](auto& held, const auto& number) { ContactImpulse::for_each_number(held, number); });
  archive.numbers("forces/collected", record.collected);
  archive.counts("forces/slept", record.slept);
}

/// Returns whether the blocks are in order and none is empty. A small file with many empty blocks
/// would take a lot of memory.
template <int D>
bool are_sound(const std::vector<BlockKey>& keys, const std::vector<std::int32_t>& first,
               std::size_t particles) {
  bool sound = first.front() == 0 && std::size_t(first.back()) == particles;
  for (std::size_t i = 0; i < keys.size(); ++i)
    sound = sound && first[i] < first[i + 1] && (i == 0 || keys[i - 1] < keys[i]) &&
            block_key<D>(block_coord<D>(keys[i]), field_of(keys[i])) == keys[i];
  return sound;
}

template <class T, int D>
double bytes_of_grid(const BlockLayout<D>& layout, int tile_size) {
  const double tiles = double(layout.particle_blocks.size()) * tile_size;
  return sizeof(T) * (tiles + 2.0 * double(layout.grid_blocks.size()) * Grid<T, D>::block_size);
}

/// Returns the layout of the blocks that were read. Refuses blocks that are empty, not in order or
/// too many for the memory.
template <class T, int D>
BlockLayout<D> whole_layout(const StateReader& archive, BlockLayout<D> read, std::size_t particles,
                            int tile_size) {
  if (!are_sound<D>(read.particle_blocks, read.first, particles))
    archive.refuse("the blocks of particles are empty or not in order");
  auto layout = BlockLayout<D>::of(std::move(read.particle_blocks), std::move(read.first), 1);
  if (bytes_of_grid<T>(layout, tile_size) > double(available_memory_bytes()))
    archive.refuse("its " + std::to_string(layout.particle_blocks.size()) +
                   " blocks of particles do not fit into memory");
  return layout;
}

void check_materials(const StateReader& archive, const AlignedVector<std::uint8_t>& ids,
                     std::size_t materials) {
  for (const std::uint8_t id : ids)
    if (id >= materials)
      archive.refuse("a particle has the material_id " + std::to_string(id) +
                     ", but there are only " + std::to_string(materials) + " snows");
}

}  // namespace

template <class T, int D>
void SolverImpl<T, D>::save(io::BinaryWriter& out) const {
  soundness_.require();
  StateWriter archive(out);
  CheckpointParts<T, D> stored{state_.contacts.stored_impulses(), state_.sleep.states(),
                               state_.event_contacts, state_.contacts.stored_forces()};
  visit_particles(archive, state_.particles, model_.materials.size());
  visit_rest<T, D>(archive, state_.layout, stored, state_.totals, model_.options.settings);
  if (!state_.forces) return;
  visit_forces<T, D>(archive, stored, *state_.forces);
  state_.forces->forces.save(out);
}

template <class T, int D>
State<T, D> SolverImpl<T, D>::read_state(const io::BinaryReader& in) const {
  const StateReader archive(in);
  State<T, D> next(model_);
  CheckpointParts<T, D> stored;
  visit_particles(archive, next.particles, model_.materials.size());
  check_materials(archive, next.particles.material_id, model_.materials.size());
  visit_rest<T, D>(archive, next.layout, stored, next.totals, model_.options.settings);
  next.find_elastic_limits(model_);
  next.layout = whole_layout<T>(archive, std::move(next.layout), next.particles.size(),
                                workspace_.grid.tile_size);
  next.contacts =
      next.contacts.relocated(model_.boundary, next.layout.grid_blocks, next.totals.time);
  next.contacts.restore(stored.impulses);
  if (next.forces) read_forces(in, next);
  next.sleep = next.sleep.with_states(next.layout, std::move(stored.sleep));
  next.event_contacts = std::move(stored.event_contacts);
  next.find_event_fields();
  return next;
}

/// A checkpoint of a run that did not record forces has none; the record begins then.
template <class T, int D>
void SolverImpl<T, D>::read_forces(const io::BinaryReader& in, State<T, D>& next) const {
  if (in.has("forces/block")) {
    const StateReader archive(in);
    CheckpointParts<T, D> stored;
    visit_forces<T, D>(archive, stored, *next.forces);
    next.forces->forces.load(in);
    next.contacts.restore(stored.forces);
  } else {
    next.begin_balance();
    next.forces->collected = next.totals.time;
  }
  next.contacts.find_patches(model_.boundary, next.totals.time, next.forces->forces.pressures());
}

template <class T, int D>
void SolverImpl<T, D>::load(const io::BinaryReader& in) {
  accept(read_state(in));
  workspace_.since_sort = 0;
  soundness_ = {};
}

template <class T, int D>
void SolverImpl<T, D>::check(const io::BinaryReader& in) const {
  read_state(in);
}

template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

}  // namespace snowshed::methods::mpm
