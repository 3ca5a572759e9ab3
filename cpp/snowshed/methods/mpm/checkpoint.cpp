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
  particles_.for_each_array([&out](const char* name, const auto& array) {
    out.add(std::string("particles/") + name, array);
  });
  out.add("blocks/keys", layout_.particle_blocks);
  out.add("blocks/first", layout_.first);

  std::vector<std::uint64_t> block;
  std::vector<std::int32_t> node, obstacle;
  std::vector<double> amount;
  for (const auto& d : contacts_.stored_impulses()) {
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
  for (const auto& s : sleep_.states())
    for (const double value : sleep_record<D>(s)) sleep.push_back(value);
  out.add("sleep", std::move(sleep));

  const EnergyBalance& b = energy_balance_;
  out.add("energy",
          std::vector<double>{b.kinetic, b.gravitational, b.elastic, b.plastic, b.friction,
                              b.sticking, b.impact, b.transfer, b.sleep, b.added});
  out.add("clock", std::vector<double>{time_, dt_, speed_, counters_.smallest_dt, stress_power_});
  out.add("counters", std::vector<std::int64_t>{counters_.steps, counters_.rejected,
                                                counters_.sorts, counters_.particle_updates,
                                                counters_.slept_updates, std::int64_t(next_id_)});
}

template <class T, int D>
void MpmSolver<T, D>::load(const BinaryReader& in) {
  const std::size_t n = in.view<T>("particles/mass").size;
  particles_.resize(n);
  particles_.for_each_array([&in, n](const char* name, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    const auto values = in.get<Value>(std::string("particles/") + name, n);
    std::copy(values.begin(), values.end(), array.begin());
  });
  for (const std::uint8_t material_id : particles_.material_id)
    if (material_id >= materials_.size())
      throw InputError(in.path().string(), "a particle of snow " + std::to_string(material_id) +
                                               " of " + std::to_string(materials_.size()));
  find_elastic_limits();
  auto keys = in.get<std::uint64_t>("blocks/keys");
  auto first = in.get<std::int32_t>("blocks/first", keys.size() + 1);
  if (!are_sound<D>(keys, first, n))
    throw InputError(in.path().string(), "the blocks of particles are empty or not in order");
  layout_ = {};
  layout_.assign(std::move(keys), std::move(first), threads());
  if (bytes_of_grid<T>(layout_, grid_.tile_size) > double(available_memory_bytes()))
    throw InputError(in.path().string(), "its " + std::to_string(layout_.particle_blocks.size()) +
                                             " blocks of particles do not fit into memory");

  const auto clock = in.get<double>("clock", 5);
  time_ = clock[0];
  dt_ = clock[1];
  speed_ = clock[2];
  counters_.smallest_dt = clock[3];
  stress_power_ = clock[4];
  const auto counts = in.get<std::int64_t>("counters", 6);
  counters_.steps = counts[0];
  counters_.rejected = counts[1];
  counters_.sorts = counts[2];
  counters_.particle_updates = counts[3];
  counters_.slept_updates = counts[4];
  next_id_ = std::uint32_t(counts[5]);
  const auto e = in.get<double>("energy", 10);
  energy_balance_ = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8], e[9]};

  contacts_.relocate({}, time_);
  contacts_.relocate(layout_.grid_blocks, time_);
  const auto block = in.get<std::uint64_t>("pressed/block");
  const auto node = in.get<std::int32_t>("pressed/node", block.size());
  const auto obstacle = in.get<std::int32_t>("pressed/obstacle", block.size());
  const auto amount = in.get<double>("pressed/amount", block.size());
  std::vector<typename Contacts<T, D>::StoredImpulse> stored;
  for (std::size_t i = 0; i < block.size(); ++i)
    stored.push_back({block[i], node[i], obstacle[i], amount[i]});
  contacts_.restore(stored);
  grid_.resize(layout_);
  const std::size_t blocks = layout_.particle_blocks.size();
  const auto sleep = in.get<double>("sleep", blocks * sleep_values<D>);
  std::vector<typename Sleep<D>::State> states;
  for (std::size_t i = 0; i < blocks; ++i)
    states.push_back(sleep_state<D>(&sleep[i * sleep_values<D>]));
  sleep_.restore(layout_, std::move(states));
  tiles_valid_ = false;
  since_sort_ = 0;
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
