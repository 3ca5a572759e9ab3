#include "snowshed/methods/mpm/event_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/methods/mpm/energy_rule.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

template <class T, int D>
bool share_a_node(const T* first, const T* second) {
  for (int k = 0; k < block_nodes<D> * node_values; k += node_values)
    if (is_shared(first[k], second[k])) return true;
  return false;
}

}  // namespace

template <class T, int D>
void EventContacts<T, D>::forget(const Model<T, D>& model, const State<T, D>& state, int threads) {
  const BlockLayout<D>& layout = state.layout;
  measured_ = false;
  pairs_.clear();
  first_pair_.assign(1, 0);
  radius_.clear();
  for (std::ptrdiff_t overlap = 0; overlap < overlap_count(layout); ++overlap) {
    for (std::int32_t a = layout.overlap_first[overlap]; a < layout.overlap_first[overlap + 1]; ++a)
      for (std::int32_t b = a + 1; b < layout.overlap_first[overlap + 1]; ++b)
        pairs_.push_back({a, b});
    first_pair_.push_back(std::int32_t(pairs_.size()));
  }
  travel_.assign(pairs_.size(), 0.0);
  fastest_.resize(layout.overlap_blocks.size());
  if (pairs_.empty()) return;
  nodes_around_.clear();
  for (const std::int32_t g : layout.overlap_blocks)
    nodes_around_.push_back(layout.nodes_around(g));
  radius_.resize(state.particles.size());
  const double dx = model.options.settings.dx;
  parallel_for_static(std::ptrdiff_t(radius_.size()), threads, [&](std::ptrdiff_t i) {
    radius_[i] = T(state.contact_radius(model, std::size_t(i)) / dx);
  });
}

template <class T, int D>
void EventContacts<T, D>::update(const Model<T, D>& model, State<T, D>& state, Grid<T, D>& grid,
                                 int threads) {
  find_due(state, grid, model.options.settings.dx);
  if (std::find(due_.begin(), due_.end(), 1) == due_.end()) return;
  Contacts sorted;
  if (!measured_) {
    sorted = state.event_contacts;
    std::sort(sorted.begin(), sorted.end());
  }
  const Contacts& before = measured_ ? state.event_contacts : sorted;
  const EventContact<T>* const earlier = before.data();
  const std::ptrdiff_t overlaps = overlap_count(state.layout);
  std::vector<Contacts> by_overlap(overlaps);
  std::vector<std::int32_t> first(pairs_.size() + 1, 0);
  parallel_for_dynamic(overlaps, threads, 1, [&](std::ptrdiff_t overlap) {
    Contacts& contacts = by_overlap[overlap];
    const std::int32_t first_block = state.layout.overlap_first[overlap];
    Masses masses(state.layout.overlap_first[overlap + 1] - first_block);
    for (std::int32_t k = first_pair_[overlap]; k < first_pair_[overlap + 1]; ++k) {
      const Pair& pair = pairs_[k];
      const SortedContacts of_pair =
          measured_ ? SortedContacts{earlier + first_[k], earlier + first_[k + 1]}
                    : SortedContacts{earlier, earlier + before.size()};
      const std::size_t number = contacts.size();
      if (due_[k])
        measure(model, state, grid, of_pair, pair, masses[pair.first - first_block],
                masses[pair.second - first_block], contacts);
      else
        contacts.insert(contacts.end(), of_pair.begin, of_pair.end);
      first[k + 1] = std::int32_t(contacts.size() - number);
    }
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  Contacts next;
  next.reserve(first.back());
  for (const Contacts& contacts : by_overlap)
    next.insert(next.end(), contacts.begin(), contacts.end());
  state.event_contacts = std::move(next);
  first_ = std::move(first);
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (due_[k]) travel_[k] = 0;
  measured_ = true;
}

template <class T, int D>
const EventContact<T>* EventContacts<T, D>::SortedContacts::find(
    const EventContact<T>& contact) const {
  const EventContact<T>* const at = std::lower_bound(begin, end, contact);
  return at != end && at->key() == contact.key() ? at : nullptr;
}

/// Finds the pairs whose snow may have moved far enough to change the contacts.
template <class T, int D>
void EventContacts<T, D>::find_due(const State<T, D>& state, const Grid<T, D>& grid, double dx) {
  due_.assign(pairs_.size(), std::uint8_t(!measured_));
  if (!measured_) return;
  for (std::size_t k = 0; k < fastest_.size(); ++k)
    fastest_[k] = fastest_around(state, grid, state.layout.overlap_blocks[k]);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    travel_[k] += std::max(fastest_[pairs_[k].first], fastest_[pairs_[k].second]) * state.totals.dt;
    due_[k] = travel_[k] >= contact_tolerance * dx;
  }
}

/// The speed (m/s) of the fastest snow that can reach the nodes of a block.
template <class T, int D>
double EventContacts<T, D>::fastest_around(const State<T, D>& state, const Grid<T, D>& grid,
                                           std::int32_t g) const {
  double squared = 0;
  for (const std::int32_t b : state.layout.around_nodes[g])
    if (b >= 0 && !state.sleep.states()[b].asleep)
      squared = std::max(squared, grid.block_stats[b].max_speed_squared);
  return std::sqrt(squared);
}

/// The masses at the nodes of a block of an overlap and of the margin around it.
template <class T, int D>
std::vector<T> EventContacts<T, D>::masses_of(Grid<T, D>& grid, std::int32_t overlap_block) const {
  constexpr int margin = normal_margin<D>;
  std::vector<T> masses(padded_nodes<D>, T(0));
  int k = 0;
  for_each_index(filled<D>(-1), filled<D>(2), [&](const std::array<int, D>& offset) {
    const std::int32_t block = nodes_around_[overlap_block][k++];
    if (block < 0 || !grid.touched[block]) return;
    std::array<int, D> begin, end;
    for (int d = 0; d < D; ++d) {
      begin[d] = offset[d] < 0 ? B - margin : 0;
      end[d] = offset[d] > 0 ? margin : B;
    }
    const T* const sums = grid.sum(block);
    for_each_index(begin, end, [&](const std::array<int, D>& node) {
      std::array<int, D> padded;
      for (int d = 0; d < D; ++d) padded[d] = node[d] + offset[d] * B;
      masses[flat_index<D>(padded, padded_edge<D>, -margin)] =
          sums[flat_index<D>(node, B) * node_values];
    });
  });
  return masses;
}

/// Finds how far the particles of a field reach along the normals of the nodes of block g.
template <class T, int D>
void EventContacts<T, D>::find_reach(const Model<T, D>& model, const State<T, D>& state,
                                     Grid<T, D>& grid, std::int32_t g,
                                     const SharedNodes<T, D>& nodes, ReachMap<T, D>& reach) const {
  const Particles<T, D>& p = state.particles;
  const BlockCoord<D> block = block_coord<D>(state.layout.grid_blocks[g]);
  const T offset = T(base_offset(model.options.settings.basis));
  const T* tiles[neighbour_count<D>];
  grid.tiles_reaching(state.layout, g, tiles);
  for (int around = 0; around < neighbour_count<D>; ++around) {
    if (!tiles[around]) continue;
    const std::int32_t b = state.layout.around_nodes[g][around];
    const BlockCoord<D> from = block_coord<D>(state.layout.particle_blocks[b]);
    T shift[D], low[D], high[D];  // a particle from `low` to `high` has weight at the shared nodes
    bool reaches_nodes = true;    // particles stray from their block by less than a cell
    for (int d = 0; d < D; ++d) {
      shift[d] = T((from[d] - block[d]) * B);
      low[d] = T(nodes.begin[d] - support_ + 1);
      high[d] = T(nodes.end[d]);
      reaches_nodes = reaches_nodes && shift[d] - 1 < high[d] && shift[d] + B + 1 >= low[d];
    }
    if (!reaches_nodes) continue;
    for (std::int32_t i = state.layout.first[b]; i < state.layout.first[b + 1]; ++i) {
      T x[D];
      bool near = true;
      for (int d = 0; d < D; ++d) {
        x[d] = p.cell[d][i] + shift[d];
        near = near && x[d] >= low[d] && x[d] < high[d];
      }
      if (!near) continue;
      std::array<int, D> lowest;
      for (int d = 0; d < D; ++d) {
        lowest[d] = int(x[d]) - (x[d] < T(int(x[d])));  // std::floor would be a call
        x[d] += offset;
      }
      reach.add(x, lowest, support_, radius_[i]);
    }
  }
}

/// Finds the contacts of a pair, which keep their stored impulses. A node at which the snow has
/// separated stays a contact until friction has used up its stored impulse.
template <class T, int D>
void EventContacts<T, D>::measure(const Model<T, D>& model, const State<T, D>& state,
                                  Grid<T, D>& grid, const SortedContacts& before, const Pair& pair,
                                  std::vector<T>& first_masses, std::vector<T>& second_masses,
                                  Contacts& contacts) const {
  const std::int32_t a = state.layout.overlap_blocks[pair.first],
                     b = state.layout.overlap_blocks[pair.second];
  if (!grid.touched[a] || !grid.touched[b] || !share_a_node<T, D>(grid.sum(a), grid.sum(b))) return;
  if (first_masses.empty()) first_masses = masses_of(grid, pair.first);
  if (second_masses.empty()) second_masses = masses_of(grid, pair.second);
  const SharedNodes<T, D> nodes = find_shared_nodes<T, D>(first_masses, second_masses);
  ReachMap<T, D> first(nodes, T(1)), second(nodes, T(-1));  // towards each other
  find_reach(model, state, grid, a, nodes, first);
  find_reach(model, state, grid, b, nodes, second);
  for_each_index(nodes.begin, nodes.end, [&](const std::array<int, D>& node) {
    const int k = flat_index<D>(node, B);
    if (!nodes.contains(k)) return;
    EventContact<T> c{state.layout.grid_blocks[a],
                      state.layout.grid_blocks[b],
                      k,
                      a,
                      b,
                      first.at(node) >= -second.at(node),
                      {},
                      0,
                      0};
    for (int d = 0; d < D; ++d) c.normal[d] = nodes.normal[k][d];
    if (const EventContact<T>* old = before.find(c)) c.impulse = c.next_impulse = old->next_impulse;
    if (c.touches || c.impulse > T(0)) contacts.push_back(c);
  });
}

template <class T, int D>
void EventContacts<T, D>::exchange(const Model<T, D>& model, const StepParameters<T>& step,
                                   State<T, D>& state, Grid<T, D>& grid,
                                   std::ptrdiff_t overlap) const {
  EventContact<T>* const contacts = state.event_contacts.data();
  for (std::int32_t k = first_pair_[overlap]; k < first_pair_[overlap + 1]; ++k)
    if (first_[k] < first_[k + 1])
      exchange(model, step, grid, contacts + first_[k], contacts + first_[k + 1]);
}

/// Exchanges the impulses between two fields. A part of the stored friction may suffice to stop a
/// node with little snow. The excess slows the nodes of the block that still slide.
template <class T, int D>
void EventContacts<T, D>::exchange(const Model<T, D>& model, const StepParameters<T>& step,
                                   Grid<T, D>& grid, EventContact<T>* begin,
                                   EventContact<T>* end) const {
  if (!grid.touched[begin->first] || !grid.touched[begin->second]) {
    for (EventContact<T>* c = begin; c != end; ++c) c->next_impulse = 0;
    return;
  }
  const T* const sums[2] = {grid.sum(begin->first), grid.sum(begin->second)};
  T* const velocities[2] = {grid.velocity(begin->first), grid.velocity(begin->second)};
  EventImpulses<T, D> impulses[block_nodes<D>];
  const T friction = T(model.event_friction());
  T excess = 0, capacity = 0;  // N s
  for (EventContact<T>* c = begin; c != end; ++c) {
    EventImpulses<T, D>& i = impulses[c - begin];
    i = impulses_at(step, friction, sums, velocities, *c);
    excess += i.excess();
    capacity += i.capacity();
  }
  const T share = used_share(excess, capacity);
  NodeEnergies& energy = grid.node_stats[begin->first].energy;
  for (const EventContact<T>* c = begin; c != end; ++c) {
    const EventImpulses<T, D>& i = impulses[c - begin];
    if (!i.any()) continue;
    const T rubbing = i.rubbing(share);
    for (int field = 0; field < 2; ++field) {
      const T* const sum = sums[field] + c->node * node_values;
      T* const node = velocities[field] + c->node * node_values;
      const T per_mass = (field == 0 ? T(-1) : T(1)) / sum[0];
      for (int d = 0; d < D; ++d) {
        const T pushed = per_mass * i.push * c->normal[d], rubbed = per_mass * rubbing * i.slip[d];
        if (model.options.energy)
          add_exchange(double(sum[0]), double(sum[1 + d]), double(pushed), double(rubbed),
                       double(node[d] + pushed + rubbed), energy);
        node[d] += pushed + rubbed;
        node[node_values / 2 + d] += pushed + rubbed;
      }
    }
  }
}

template <class T, int D>
EventImpulses<T, D> EventContacts<T, D>::impulses_at(const StepParameters<T>& step, T friction,
                                                     const T* const (&sums)[2],
                                                     T* const (&velocities)[2],
                                                     EventContact<T>& c) const {
  const int at = c.node * node_values;
  T difference[D];
  for (int d = 0; d < D; ++d) difference[d] = velocities[0][at + d] - velocities[1][at + d];
  const FrictionRates<T> rates{step.friction_rate, step.friction_rate_per_speed};
  return event_impulses(rates, friction, sums[0][at], sums[1][at], difference, c);
}

template class EventContacts<float, 2>;
template class EventContacts<float, 3>;
template class EventContacts<double, 2>;
template class EventContacts<double, 3>;

}  // namespace snowshed::methods::mpm
