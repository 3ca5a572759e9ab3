// Saving and restoring a solver. Called at safe points, where the grid holds nothing that the
// particles and the contacts' stored impulses do not determine.
#include "mpm/solver_of.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/support/error.hpp"

namespace snowshed {

template <class T, int D>
void SolverOf<T, D>::save(BinaryWriter& out) const {
  particles_.for_each_array([&out](const char* name, const auto& array) {
    out.add(std::string("particles/") + name, array);
  });
  out.add("blocks/keys", layout_.particle_blocks);
  out.add("blocks/first", layout_.first);

  std::vector<std::uint64_t> block;
  std::vector<std::int32_t> node, obstacle;
  std::vector<double> amount;
  for (const auto& d : contacts_.pressed()) {
    block.push_back(d.block);
    node.push_back(d.node);
    obstacle.push_back(d.obstacle);
    amount.push_back(d.amount);
  }
  out.add("pressed/block", std::move(block));
  out.add("pressed/node", std::move(node));
  out.add("pressed/obstacle", std::move(obstacle));
  out.add("pressed/amount", std::move(amount));

  std::vector<double> since, start_speed;
  std::vector<std::uint16_t> asleep;
  for (const auto& s : sleep_.states()) {
    since.push_back(s.quiet.since);
    start_speed.push_back(s.quiet.start_speed);
    asleep.push_back(s.asleep);
  }
  out.add("sleep/since", std::move(since));
  out.add("sleep/start_speed", std::move(start_speed));
  out.add("sleep/asleep", std::move(asleep));

  const EnergyBooks& b = books_;
  out.add("energy", std::vector<double>{b.kinetic, b.gravitational, b.elastic, b.plastic,
                                        b.friction, b.sticking, b.impact, b.transfer, b.sleep, b.added});
  out.add("clock", std::vector<double>{time_, dt_, speed_, counters_.smallest_dt});
  out.add("counters",
          std::vector<std::int64_t>{counters_.steps, counters_.rejected, counters_.sorts,
                                    counters_.particle_updates, counters_.slept_updates,
                                    std::int64_t(next_id_)});
}

template <class T, int D>
void SolverOf<T, D>::load(const BinaryReader& in) {
  const std::size_t n = in.view<T>("particles/mass").size;
  particles_.resize(n);
  particles_.for_each_array([&in, n](const char* name, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    const auto values = in.get<Value>(std::string("particles/") + name, n);
    std::copy(values.begin(), values.end(), array.begin());
  });
  auto keys = in.get<std::uint64_t>("blocks/keys");
  auto first = in.get<std::int32_t>("blocks/first", keys.size() + 1);
  bool ordered = first.front() == 0 && std::size_t(first.back()) == n;
  for (std::size_t i = 0; i < keys.size(); ++i)
    ordered = ordered && first[i] <= first[i + 1] && (i == 0 || keys[i - 1] < keys[i]);
  if (!ordered) throw InputError(in.path().string(), "the blocks of particles are not in order");
  layout_ = {};
  layout_.assign(std::move(keys), std::move(first), threads());

  const auto clock = in.get<double>("clock", 4);
  time_ = clock[0];
  dt_ = clock[1];
  speed_ = clock[2];
  counters_.smallest_dt = clock[3];
  const auto counts = in.get<std::int64_t>("counters", 6);
  counters_.steps = counts[0];
  counters_.rejected = counts[1];
  counters_.sorts = counts[2];
  counters_.particle_updates = counts[3];
  counters_.slept_updates = counts[4];
  next_id_ = std::uint32_t(counts[5]);
  const auto e = in.get<double>("energy", 10);
  books_ = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8], e[9]};

  contacts_.relocate({}, time_);
  contacts_.relocate(layout_.grid_blocks, time_);
  const auto block = in.get<std::uint64_t>("pressed/block");
  const auto node = in.get<std::int32_t>("pressed/node", block.size());
  const auto obstacle = in.get<std::int32_t>("pressed/obstacle", block.size());
  const auto amount = in.get<double>("pressed/amount", block.size());
  std::vector<typename Contacts<T, D>::Press> stored;
  for (std::size_t i = 0; i < block.size(); ++i)
    stored.push_back({block[i], node[i], obstacle[i], amount[i]});
  contacts_.restore(stored);
  grid_.resize(layout_);
  const auto since = in.get<double>("sleep/since", layout_.particle_blocks.size());
  const auto start_speed = in.get<double>("sleep/start_speed", since.size());
  const auto asleep = in.get<std::uint16_t>("sleep/asleep", since.size());
  std::vector<typename Sleep<D>::State> states;
  for (std::size_t i = 0; i < since.size(); ++i)
    states.push_back({{since[i], start_speed[i]}, asleep[i] != 0});
  sleep_.restore(layout_, std::move(states));
  tiles_valid_ = false;
  since_sort_ = 0;
}

template class SolverOf<float, 2>;
template class SolverOf<float, 3>;
template class SolverOf<double, 2>;
template class SolverOf<double, 3>;

}  // namespace snowshed
