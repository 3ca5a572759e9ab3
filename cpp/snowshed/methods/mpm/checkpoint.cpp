// Saving and restoring a solver. Called at safe points, where the grid holds nothing that the
// particles and the contacts' stored impulses do not determine.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {
namespace {

/// Blocks without particles would take memory out of all proportion to the file.
template <int D>
bool are_sound(const std::vector<BlockKey>& keys, const std::vector<std::int32_t>& first,
               std::size_t particles) {
  bool sound = first.front() == 0 && std::size_t(first.back()) == particles;
  for (std::size_t i = 0; i < keys.size(); ++i)
    sound = sound && first[i] < first[i + 1] && (i == 0 || keys[i - 1] < keys[i]) &&
            block_key<D>(block_coord<D>(keys[i])) == keys[i];
  return sound;
}

template <class T, int D>
double bytes_of_grid(const BlockLayout<D>& layout, int tile_size) {
  const double tiles = double(layout.particle_blocks.size()) * tile_size;
  return sizeof(T) * (tiles + 2.0 * double(layout.grid_blocks.size()) * Grid<T, D>::block_size);
}

template <int D>
constexpr std::size_t sleep_values = 4 + 2 * D;

template <int D>
std::array<double, sleep_values<D>> sleep_record(const typename Sleep<D>::State& s) {
  std::array<double, sleep_values<D>> record{double(s.asleep), s.since, s.samples,
                                             double(s.halfway)};
  std::copy_n(s.sum.data(), D, record.begin() + 4);
  std::copy_n(s.first_half.data(), D, record.begin() + 4 + D);
  return record;
}

template <int D>
typename Sleep<D>::State sleep_state(const double* record) {
  typename Sleep<D>::State s;
  s.asleep = record[0] != 0;
  s.since = record[1];
  s.samples = record[2];
  s.halfway = record[3] != 0;
  std::copy_n(record + 4, D, s.sum.data());
  std::copy_n(record + 4 + D, D, s.first_half.data());
  return s;
}

}  // namespace

template <class T, int D>
void MpmSolver<T, D>::save(BinaryWriter& out) const {
  require_sound();
  state_.particles.for_each_array([&out](const char* name, const auto& array) {
    out.add(std::string("particles/") + name, array);
  });
  out.add("blocks/keys", state_.layout.particle_blocks);
  out.add("blocks/first", state_.layout.first);

  std::vector<std::uint64_t> block;
  std::vector<std::int32_t> node, obstacle;
  std::vector<double> amount;
  for (const auto& d : state_.contacts.stored_impulses()) {
    block.push_back(d.block);
    node.push_back(d.node);
    obstacle.push_back(d.obstacle);
    amount.push_back(d.amount);
  }
  out.add("pressed/block", std::move(block));
  out.add("pressed/node", std::move(node));
  out.add("pressed/obstacle", std::move(obstacle));
  out.add("pressed/amount", std::move(amount));

  std::vector<double> sleep;
  for (const auto& s : state_.sleep.states())
    for (const double value : sleep_record<D>(s)) sleep.push_back(value);
  out.add("sleep", std::move(sleep));

  const Progress& p = state_.progress;
  const EnergyBalance& e = p.energy;
  const StepCounters& c = p.counters;
  out.add("energy",
          std::vector<double>{e.kinetic, e.gravitational, e.elastic, e.plastic, e.friction,
                              e.sticking, e.impact, e.transfer, e.sleep, e.added});
  out.add("clock", std::vector<double>{p.time, p.dt, p.speed, c.smallest_dt, p.stress_power});
  out.add("counters", std::vector<std::int64_t>{c.steps, c.rejected, c.sorts, c.particle_updates,
                                                c.slept_updates, std::int64_t(p.next_id)});
}

namespace {

/// Arrays that a solver with one snow may do without, and one with several has.
bool is_of_several_snows(const std::string& name) { return name == "kind" || name == "plastic"; }

template <class T, int D>
void read_particles(const BinaryReader& in, std::size_t materials, Particles<T, D>& particles) {
  const std::size_t n = in.view<T>("particles/mass").size;
  particles.resize(n);
  particles.for_each_array([&in, n, materials](const char* name, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    if (materials > 1 && is_of_several_snows(name) && !in.has(std::string("particles/") + name)) {
      std::fill(array.begin(), array.end(), Value(0));  // all are of the first snow
      return;
    }
    const auto values = in.get<Value>(std::string("particles/") + name, n);
    std::copy(values.begin(), values.end(), array.begin());
  });
  for (const std::uint8_t material_id : particles.material_id)
    if (material_id >= materials)
      throw InputError(in.path().string(), "a particle of snow " + std::to_string(material_id) +
                                               " of " + std::to_string(materials));
}

template <class T, int D>
BlockLayout<D> read_layout(const BinaryReader& in, std::size_t particles, int tile_size,
                           int threads) {
  auto keys = in.get<std::uint64_t>("blocks/keys");
  auto first = in.get<std::int32_t>("blocks/first", keys.size() + 1);
  if (!are_sound<D>(keys, first, particles))
    throw InputError(in.path().string(), "the blocks of particles are empty or not in order");
  auto layout = BlockLayout<D>::of(std::move(keys), std::move(first), threads);
  if (bytes_of_grid<T>(layout, tile_size) > double(available_memory_bytes()))
    throw InputError(in.path().string(), "its " + std::to_string(layout.particle_blocks.size()) +
                                             " blocks of particles do not fit into memory");
  return layout;
}

Progress read_progress(const BinaryReader& in) {
  Progress p;
  const auto clock = in.get<double>("clock", 5);
  p.time = clock[0];
  p.dt = clock[1];
  p.speed = clock[2];
  p.counters.smallest_dt = clock[3];
  p.stress_power = clock[4];
  const auto counts = in.get<std::int64_t>("counters", 6);
  p.counters.steps = counts[0];
  p.counters.rejected = counts[1];
  p.counters.sorts = counts[2];
  p.counters.particle_updates = counts[3];
  p.counters.slept_updates = counts[4];
  p.next_id = std::uint32_t(counts[5]);
  const auto e = in.get<double>("energy", 10);
  p.energy = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8], e[9]};
  return p;
}

template <class T, int D>
std::vector<typename Contacts<T, D>::StoredImpulse> read_impulses(const BinaryReader& in) {
  const auto block = in.get<std::uint64_t>("pressed/block");
  const auto node = in.get<std::int32_t>("pressed/node", block.size());
  const auto obstacle = in.get<std::int32_t>("pressed/obstacle", block.size());
  const auto amount = in.get<double>("pressed/amount", block.size());
  std::vector<typename Contacts<T, D>::StoredImpulse> stored;
  for (std::size_t i = 0; i < block.size(); ++i)
    stored.push_back({block[i], node[i], obstacle[i], amount[i]});
  return stored;
}

template <int D>
std::vector<typename Sleep<D>::State> read_sleep(const BinaryReader& in, std::size_t blocks) {
  const auto records = in.get<double>("sleep", blocks * sleep_values<D>);
  std::vector<typename Sleep<D>::State> states;
  for (std::size_t i = 0; i < blocks; ++i)
    states.push_back(sleep_state<D>(&records[i * sleep_values<D>]));
  return states;
}

}  // namespace

template <class T, int D>
MpmState<T, D> MpmSolver<T, D>::read_state(const BinaryReader& in) const {
  MpmState<T, D> next(model_);
  read_particles(in, model_.materials.size(), next.particles);
  next.find_elastic_limits(model_);
  next.layout = read_layout<T, D>(in, next.particles.size(), work_.grid.tile_size, 1);
  next.progress = read_progress(in);
  next.contacts =
      next.contacts.relocated(model_.boundary, next.layout.grid_blocks, next.progress.time);
  next.contacts.restore(read_impulses<T, D>(in));
  next.sleep =
      next.sleep.restored(next.layout, read_sleep<D>(in, next.layout.particle_blocks.size()));
  return next;
}

template <class T, int D>
void MpmSolver<T, D>::load(const BinaryReader& in) {
  accept(read_state(in));
  work_.since_sort = 0;
  broken_ = false;
}

template <class T, int D>
void MpmSolver<T, D>::check(const BinaryReader& in) const {
  read_state(in);
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
