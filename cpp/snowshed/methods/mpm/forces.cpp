// The record of the forces on obstacles.
//
// Each node's contact gives the snow an impulse, m (v - v_free), in each step; the obstacle
// receives the opposite. Sleeping snow takes part in no step. Its contacts keep their mean forces.
// The balance of momentum gives the part that these lack to hold the snow in place.
#include <map>
#include <numeric>
#include <utility>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Time over which a contact's force is averaged, s. Snow falls asleep after about this time, and
/// a slab vibrates several times in it.
constexpr double mean_time = 0.05;

/// A contact without snow forgets its age at this share of the rate at which it grew, because
/// vibrating snow leaves its contacts for moments.
constexpr double forgetting = 0.25;

template <int D, class T, int size>
Vec3 vector_of(const T (&values)[size]) {
  VecD<D> v;
  for (int d = 0; d < D; ++d) v[d] = double(values[d]);
  return embed(v);
}

/// The mean force on an obstacle at a contact, N.
template <class T, int D>
ContactImpulse mean_force(const BlockCoord<D>& block, const Contact<T>& c,
                          const ContactForce<T>& force, double dx) {
  return ContactImpulse::at(embed(node_position<D>(block, c.node, dx)), vector_of<D>(c.normal),
                            -vector_of<D>(force.mean));
}

template <class T, int D>
double mean_push(const Contact<T>& c, const ContactForce<T>& force) {
  return vector_of<D>(force.mean).dot(vector_of<D>(c.normal));
}

/// Moves the sum of a contact into its mean force over the last `duration` seconds.
template <class T, int D>
void update_mean(ContactForce<T>& force, bool empty, T duration) {
  if (!(duration > T(0)) || (empty && force.age == T(0))) return;
  const T share = duration / std::max(std::min(force.age + duration, T(mean_time)), duration);
  for (int d = 0; d < D; ++d) force.mean[d] += share * (force.sum[d] / duration - force.mean[d]);
  if (!empty) {
    force.age = std::min(force.age + duration, T(mean_time));
  } else if ((force.age -= T(forgetting) * duration) <= T(0)) {
    force.age = 0;
    std::fill_n(force.mean, D, T(0));
  }
}

/// Sets of blocks that hang together.
class Islands {
 public:
  explicit Islands(std::size_t blocks) : parent_(blocks) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t of(std::int32_t block) {
    while (parent_[block] != block) block = parent_[block] = parent_[parent_[block]];
    return block;
  }
  void join(std::int32_t a, std::int32_t b) { parent_[of(b)] = of(a); }

 private:
  std::vector<std::int32_t> parent_;
};

/// Whether the particles of each block touch the nodes of its neighbours, as `BlockStats::reach`.
template <class T, int D>
int reach_of(const State<T, D>& state, std::int32_t block, int support) {
  int reach = 0;
  for (std::int32_t i = state.layout.first[block]; i < state.layout.first[block + 1]; ++i)
    for (int d = 0; d < D; ++d) {
      const int lowest = int(std::floor(state.particles.cell[d][i]));
      if (lowest < 0) reach |= below(d);
      if (lowest + support > block_edge<D>) reach |= above(d);
    }
  return reach;
}

/// Calls f(particle block) for the blocks whose snow reaches the nodes of a grid block.
template <int D, class F>
void for_each_reaching(const BlockLayout<D>& layout, const std::vector<int>& reach, std::size_t g,
                       const F& f) {
  for (int k = 0; k < neighbour_count<D>; ++k) {
    const std::int32_t block = layout.around_nodes[g][k];
    if (block >= 0 && reaches<D>(reach[std::size_t(block)], neighbour_count<D> - 1 - k)) f(block);
  }
}

/// The blocks of snow that hang together by their nodes, also in different fields of events.
template <class T, int D>
Islands find_islands(const State<T, D>& state, const std::vector<int>& reach) {
  const BlockLayout<D>& layout = state.layout;
  Islands islands(layout.particle_blocks.size());
  std::vector<std::int32_t> of_nodes(layout.grid_blocks.size(), -1);
  for (std::size_t g = 0; g < of_nodes.size(); ++g)
    for_each_reaching<D>(layout, reach, g, [&](std::int32_t block) {
      if (of_nodes[g] >= 0) islands.join(of_nodes[g], block);
      of_nodes[g] = block;
    });
  for (std::size_t i = 0; i + 1 < layout.overlap_first.size(); ++i) {
    std::int32_t last = -1;
    for (auto k = layout.overlap_first[i]; k < layout.overlap_first[i + 1]; ++k) {
      const std::int32_t block = of_nodes[std::size_t(layout.overlap_blocks[std::size_t(k)])];
      if (block < 0) continue;
      if (last >= 0) islands.join(last, block);
      last = block;
    }
  }
  return islands;
}

/// Forces by island and name of the obstacle, N.
using IslandForces = std::map<std::pair<std::int32_t, std::size_t>, ContactImpulse>;

/// Adds to the forces on obstacles what an island's weight requires beyond them, in proportion to
/// how strongly each of them is pressed.
void complete(IslandForces& forces, const std::vector<double>& mass, double gravity) {
  std::map<std::int32_t, std::pair<Vec3, double>> sums;  // by island: force, and positive pushes
  for (const auto& [key, force] : forces) {
    auto& sum = sums.try_emplace(key.first, Vec3::Zero(), 0.0).first->second;
    sum.first += force.total();
    sum.second += std::max(force.push, 0.0);
  }
  for (auto& [key, force] : forces) {
    const auto& [sum, pushes] = sums.at(key.first);
    if (!(pushes > 0) || !(force.push > 0)) continue;
    const Vec3 weight(0, 0, -mass[std::size_t(key.first)] * gravity);
    force.add_at_center(force.push / pushes * (weight - sum));
  }
}

}  // namespace

// --- the balance of momentum ---------------------------------------------------------------------

template <class T, int D>
Momentum State<T, D>::momentum() const {
  Momentum m;
  VecD<D> sum = VecD<D>::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double mass = double(particles.mass[i]);
    m.mass += mass;
    for (int d = 0; d < D; ++d) sum[d] += mass * double(particles.velocity[d][i]);
  }
  m.momentum = embed(sum);
  return m;
}

template <class T, int D>
void State<T, D>::begin_balance() noexcept {
  if (forces) forces->forces.begin_balance(momentum());
}

template <class T, int D>
void State<T, D>::end_balance(const Model<T, D>& model) {
  if (!forces) return;
  collect_forces(model);
  const Vec3 left = forces->forces.end_balance(momentum());
  const bool slept = forces->slept;
  forces->slept = false;
  if (!slept) return forces->forces.leave_unbalanced(left);
  // The obstacles below sleeping snow; where its nodes all touch awake snow, those that were
  // pressed just now.
  std::vector<ContactImpulse> below = forces->held;
  const auto pushes_of = [](const std::vector<ContactImpulse>& all) {
    double sum = 0;
    for (const ContactImpulse& force : all) sum += std::max(force.push, 0.0);
    return sum;
  };
  if (!(pushes_of(below) > 0))
    for (std::size_t name = 0; name < below.size(); ++name)
      below[name] = forces->forces.forces()[name].recent;
  const double pushes = pushes_of(below);
  if (!(pushes > 0)) return forces->forces.leave_unbalanced(left);
  for (std::size_t name = 0; name < below.size(); ++name) {
    if (!(below[name].push > 0)) continue;
    ContactImpulse more = below[name];
    more.add_at_center(-below[name].push / pushes * left);
    forces->forces.give(name, more - below[name]);
  }
}

// --- the steps -----------------------------------------------------------------------------------

/// Gives the sum of a contact to the record of forces.
template <class T, int D>
void collect(ObstacleForces& record, const BlockCoord<D>& block, const Contact<T>& c,
             ContactForce<T>& force, double dx) {
  const ContactImpulse impulse = ContactImpulse::at(
      embed(node_position<D>(block, c.node, dx)), vector_of<D>(c.normal), -vector_of<D>(force.sum));
  record.add(record.name_of(c.obstacle), impulse);
  if (force.patch >= 0) record.pressures().push(force.patch, impulse.push);
  std::fill_n(force.sum, 4, T(0));
}

template <class T, int D>
void State<T, D>::collect_forces(const Model<T, D>& model,
                                 const std::vector<std::int32_t>& idle) noexcept {
  ObstacleForces& record = forces->forces;
  const double duration = totals.time - forces->collected, dx = model.options.settings.dx;
  std::size_t next_idle = 0;
  for (std::size_t g = 0; g < layout.grid_blocks.size(); ++g) {
    while (next_idle < idle.size() && std::size_t(idle[next_idle]) < g) ++next_idle;
    const int count = contacts.count(g);
    if (count == 0) continue;
    const bool slept = next_idle < idle.size() && std::size_t(idle[next_idle]) == g;
    const BlockCoord<D> block = block_coord<D>(layout.grid_blocks[g]);
    const Contact<T>* contact = contacts.of_block(g);
    ContactForce<T>* force = contacts.forces_of(g);
    for (int k = 0; k < count; ++k) {
      ContactForce<T>& f = force[k];
      sum_impulse(f);
      const bool empty = is_empty(f);
      if (empty && f.age == T(0)) continue;
      if (slept && f.age > T(0)) {  // its mean force stays
        record.pressures().push(f.patch, duration * mean_push<T, D>(contact[k], f));
        record.add(record.name_of(contact[k].obstacle), mean_force<T, D>(block, contact[k], f, dx),
                   duration);
      }
      if (!slept) update_mean<T, D>(f, empty, T(duration));
      if (!empty) collect<T, D>(record, block, contact[k], f, dx);
    }
  }
  record.end_interval(duration, Vec3(0, 0, -record.mass() * model.options.gravity * duration));
  forces->collected = totals.time;
}

template <class T, int D>
void State<T, D>::collect_vanishing_forces(const Model<T, D>& model,
                                           const std::vector<BlockKey>& next) noexcept {
  auto at = next.begin();
  for (std::size_t g = 0; g < layout.grid_blocks.size(); ++g) {
    while (at != next.end() && *at < layout.grid_blocks[g]) ++at;
    if (at != next.end() && *at == layout.grid_blocks[g]) continue;
    const BlockCoord<D> block = block_coord<D>(layout.grid_blocks[g]);
    for (int k = 0; k < contacts.count(g); ++k) {
      const Contact<T>& contact = contacts.of_block(g)[k];
      ContactForce<T>& f = contacts.forces_of(g)[k];
      sum_impulse(f);
      if (is_empty(f)) continue;
      collect<T, D>(forces->forces, block, contact, f, model.options.settings.dx);
    }
  }
}

template <class T, int D>
void State<T, D>::follow_obstacles(const Model<T, D>& model, int threads) {
  if (!model.boundary.any_motion()) return;
  if (forces) collect_forces(model);  // contacts may vanish
  contacts.follow(model.boundary, totals.time, threads);
  if (forces) contacts.find_patches(model.boundary, totals.time, forces->forces.pressures());
}

template <class T, int D>
void State<T, D>::hold_sleeping_forces(const Model<T, D>& model,
                                       const std::function<bool(std::int32_t)>& reached) noexcept {
  std::fill(forces->held.begin(), forces->held.end(), ContactImpulse());
  for (const std::int32_t g : sleep.idle()) {
    const int count = contacts.count(std::size_t(g));
    if (count == 0) continue;
    const bool has_snow = reached(g);
    const BlockCoord<D> block = block_coord<D>(layout.grid_blocks[g]);
    const Contact<T>* contact = contacts.of_block(std::size_t(g));
    ContactForce<T>* force = contacts.forces_of(std::size_t(g));
    for (int k = 0; k < count; ++k) {
      if (!has_snow) {  // and hence no force
        force[k].age = 0;
        std::fill_n(force[k].mean, D, T(0));
      } else if (force[k].age > T(0)) {
        forces->held[forces->forces.name_of(contact[k].obstacle)] +=
            mean_force<T, D>(block, contact[k], force[k], model.options.settings.dx);
      }
    }
  }
}

template <class T, int D>
void State<T, D>::end_force_step(double time, double dt) noexcept {
  if (sleep.awake().size() < sleep.states().size()) forces->slept = true;
  for (std::size_t name = 0; name < forces->held.size(); ++name)
    forces->forces.add_step(name, dt * forces->held[name].total());
  forces->forces.end_step(time, dt);
}

template <class T, int D>
void State<T, D>::end_pressure_half(const Model<T, D>& model) noexcept {
  if (!forces->forces.pressures().half_is_over(totals.time)) return;
  collect_forces(model);
  forces->forces.pressures().end_half(totals.time);
}

template <class T, int D>
void SolverImpl<T, D>::hold_sleeping_forces() noexcept {
  state_.hold_sleeping_forces(model_, [this](std::int32_t g) {
    const T* tiles[neighbour_count<D>];
    return workspace_.grid.tiles_reaching(state_.layout, std::size_t(g), tiles);
  });
}

/// Records the forces of a step that was taken.
template <class T, int D>
void SolverImpl<T, D>::record_forces(double dt) noexcept {
  if (!state_.forces) return;
  ObstacleForces& forces = state_.forces->forces;
  for (const std::int32_t g : state_.sleep.active()) {
    const std::int32_t only = state_.contacts.only_obstacle(std::size_t(g));
    if (only == -1 || !workspace_.grid.touched[g]) continue;
    if (only >= 0) {
      VecD<D> impulse;
      for (int d = 0; d < D; ++d) impulse[d] = workspace_.grid.node_stats[g].impulse[d];
      forces.add_step(forces.name_of(only), -embed(impulse));
      continue;
    }
    for (int k = 0; k < state_.contacts.count(std::size_t(g)); ++k)
      forces.add_step(forces.name_of(state_.contacts.of_block(std::size_t(g))[k].obstacle),
                      -vector_of<D>(state_.contacts.forces_of(std::size_t(g))[k].impulse));
  }
  state_.end_force_step(time(), dt);
  state_.end_pressure_half(model_);
}

// --- samples -------------------------------------------------------------------------------------

template <class T, int D>
void SolverImpl<T, D>::begin_force_event() noexcept {
  if (!state_.forces) return;
  state_.collect_forces(model_);
  state_.forces->forces.begin_event(time());
}

template <class T, int D>
std::vector<ForceSample> SolverImpl<T, D>::sample_forces(double duration) {
  state_.end_balance(model_);
  return state_.forces->forces.sample(duration);
}

/// The means of all contacts. At rest they are completed island by island, because the means of
/// snow that fell asleep while it vibrated do not quite carry it.
template <class T, int D>
RestingForces SolverImpl<T, D>::resting_forces(bool at_rest) const {
  const ObstacleForces& record = state_.forces->forces;
  const BlockLayout<D>& layout = state_.layout;
  std::vector<int> reach;
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    reach.push_back(reach_of(state_, std::int32_t(b), support(model_.options.settings.basis)));
  Islands islands = find_islands(state_, reach);
  std::vector<double> mass(layout.particle_blocks.size());
  for (std::size_t b = 0; b < mass.size(); ++b)
    for (std::int32_t i = layout.first[b]; i < layout.first[b + 1]; ++i)
      mass[std::size_t(islands.of(std::int32_t(b)))] += double(state_.particles.mass[i]);

  const auto for_each_contact = [&](const auto& f) {
    for (std::size_t g = 0; g < layout.grid_blocks.size(); ++g) {
      std::int32_t island = -1;
      if (state_.contacts.count(g) > 0)
        for_each_reaching<D>(layout, reach, g,
                             [&](std::int32_t block) { island = islands.of(block); });
      if (island < 0) continue;
      for (int k = 0; k < state_.contacts.count(g); ++k) {
        const Contact<T>& c = state_.contacts.of_block(g)[k];
        f(std::pair(island, record.name_of(c.obstacle)), block_coord<D>(layout.grid_blocks[g]), c,
          state_.contacts.forces_of(g)[k]);
      }
    }
  };
  IslandForces means, completed;
  for_each_contact([&](const auto& key, const auto& block, const auto& c, const auto& force) {
    if (force.age > T(0))
      means[key] += mean_force<T, D>(block, c, force, model_.options.settings.dx);
  });
  completed = means;
  if (at_rest) complete(completed, mass, model_.options.gravity);

  const std::vector<Patch>& patches = record.pressures().patches();
  RestingForces resting{std::vector<RestingForces::OnObstacle>(record.names().size()),
                        std::vector<double>(patches.size())};
  for (const auto& [key, force] : completed) resting.forces[key.second].force += force;
  for_each_contact([&](const auto& key, const auto&, const auto& c, const auto& force) {
    if (force.age == T(0) || force.patch < 0) return;
    const double mean = means.at(key).push, factor = mean > 0 ? completed.at(key).push / mean : 1.0;
    resting.pressures[std::size_t(force.patch)] +=
        factor * mean_push<T, D>(c, force) / patches[std::size_t(force.patch)].area;
  });
  for (std::size_t i = 0; i < patches.size(); ++i)
    resting.forces[record.name_of(patches[i].obstacle())].pressed.add(patches[i],
                                                                      resting.pressures[i]);
  return resting;
}

template struct State<float, 2>;
template struct State<float, 3>;
template struct State<double, 2>;
template struct State<double, 3>;
template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

}  // namespace snowshed::methods::mpm
