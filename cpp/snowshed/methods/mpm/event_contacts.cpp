#include "snowshed/methods/mpm/event_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/methods/mpm/energy_rule.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

template <class T>
bool is_before(const EventContact<T>* a, const EventContact<T>* b) {
  return *a < *b;
}

template <class T, int D>
bool share_a_node(const T* first, const T* second) {
  for (int k = 0; k < block_nodes<D> * node_values; k += node_values)
    if (is_shared(first[k], second[k])) return true;
  return false;
}

}  // namespace

template <class T, int D>
void EventContacts<T, D>::forget(const Model<T, D>& model, const State<T, D>& state, int threads) {
  measured_ = false;
  travel_.clear();
  radius_.clear();
  if (overlap_count(state.layout) == 0) return;
  radius_.resize(state.particles.size());
  const double dx = model.options.settings.dx;
  parallel_for_static(std::ptrdiff_t(radius_.size()), threads, [&](std::ptrdiff_t i) {
    radius_[i] = T(state.contact_radius(model, std::size_t(i)) / dx);
  });
}

template <class T, int D>
void EventContacts<T, D>::update(const Model<T, D>& model, State<T, D>& state, Grid<T, D>& grid,
                                 int threads) {
  const std::ptrdiff_t overlaps = overlap_count(state.layout);
  find_due(model, state, grid);
  if (std::find(due_.begin(), due_.end(), 1) == due_.end()) return;
  const std::vector<EventContact<T>>& before = state.event_contacts;
  std::vector<const EventContact<T>*> by_key;
  for (const EventContact<T>& c : before) by_key.push_back(&c);
  // Contacts of the same layout are in order already, overlap by overlap.
  if (!measured_) std::sort(by_key.begin(), by_key.end(), is_before<T>);
  std::vector<std::vector<EventContact<T>>> by_overlap(overlaps);
  parallel_for_dynamic(overlaps, threads, 1, [&](std::ptrdiff_t overlap) {
    const SortedContacts earlier =
        measured_
            ? SortedContacts{by_key.data() + first_[overlap], by_key.data() + first_[overlap + 1]}
            : SortedContacts{by_key.data(), by_key.data() + by_key.size()};
    if (due_[overlap]) {
      measure(model, state, grid, earlier, overlap, by_overlap[overlap]);
      travel_[overlap] = 0;
    } else {
      for (auto c = earlier.begin; c != earlier.end; ++c) by_overlap[overlap].push_back(**c);
    }
  });
  std::vector<EventContact<T>> next;
  std::vector<std::int32_t> first{0};
  for (const auto& contacts : by_overlap) {
    next.insert(next.end(), contacts.begin(), contacts.end());
    first.push_back(std::int32_t(next.size()));
  }
  state.event_contacts = std::move(next);
  first_ = std::move(first);
  measured_ = true;
}

template <class T, int D>
const EventContact<T>* EventContacts<T, D>::SortedContacts::find(
    const EventContact<T>& contact) const {
  const auto at = std::lower_bound(begin, end, &contact, is_before<T>);
  return at != end && (*at)->key() == contact.key() ? *at : nullptr;
}

/// Finds the overlaps in which snow may have moved far enough to change the contacts.
template <class T, int D>
void EventContacts<T, D>::find_due(const Model<T, D>& model, const State<T, D>& state,
                                   const Grid<T, D>& grid) {
  const double tolerance = contact_tolerance * model.options.settings.dx;
  const std::ptrdiff_t overlaps = overlap_count(state.layout);
  due_.assign(overlaps, std::uint8_t(!measured_));
  travel_.resize(overlaps);
  if (!measured_) return;
  for (std::ptrdiff_t overlap = 0; overlap < overlaps; ++overlap) {
    travel_[overlap] += fastest_around(state, grid, overlap) * state.totals.dt;
    due_[overlap] = travel_[overlap] >= tolerance;
  }
}

/// The speed (m/s) of the fastest snow that can reach the nodes of an overlap.
template <class T, int D>
double EventContacts<T, D>::fastest_around(const State<T, D>& state, const Grid<T, D>& grid,
                                           std::ptrdiff_t overlap) const {
  const BlockLayout<D>& layout = state.layout;
  double squared = 0;
  for (auto k = layout.overlap_first[overlap]; k < layout.overlap_first[overlap + 1]; ++k)
    for (const std::int32_t b : layout.around_nodes[layout.overlap_blocks[k]])
      if (b >= 0 && !state.sleep.states()[b].asleep)
        squared = std::max(squared, grid.block_stats[b].max_speed_squared);
  return std::sqrt(squared);
}

/// The masses at the nodes of a block and of the margin around it.
template <class T, int D>
std::vector<T> EventContacts<T, D>::masses_of(const State<T, D>& state, Grid<T, D>& grid,
                                              std::int32_t g) const {
  constexpr int margin = normal_margin<D>;
  std::vector<T> masses(padded_nodes<D>, T(0));
  const BlockKey key = state.layout.grid_blocks[g];
  for_each_index(filled<D>(-1), filled<D>(2), [&](const std::array<int, D>& offset) {
    BlockCoord<D> coord = block_coord<D>(key);
    std::array<int, D> begin, end;
    for (int d = 0; d < D; ++d) {
      coord[d] += offset[d];
      begin[d] = offset[d] < 0 ? B - margin : 0;
      end[d] = offset[d] > 0 ? margin : B;
    }
    const std::int32_t block =
        find_block(state.layout.grid_blocks, block_key<D>(coord, field_of(key)));
    if (block < 0 || !grid.touched[block]) return;
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

/// Finds the contacts of an overlap, which keep their stored impulses. A node at which the snow has
/// separated stays a contact until friction has used up its stored impulse.
template <class T, int D>
void EventContacts<T, D>::measure(const Model<T, D>& model, const State<T, D>& state,
                                  Grid<T, D>& grid, const SortedContacts& before,
                                  std::ptrdiff_t overlap,
                                  std::vector<EventContact<T>>& contacts) const {
  const auto begin = state.layout.overlap_blocks.begin() + state.layout.overlap_first[overlap];
  const auto end = state.layout.overlap_blocks.begin() + state.layout.overlap_first[overlap + 1];
  struct Field {
    std::int32_t block;
    std::vector<T> masses;  // once they are needed
  };
  std::vector<Field> fields;
  for (auto g = begin; g != end; ++g)
    if (grid.touched[*g]) fields.push_back({*g, {}});
  for (std::size_t a = 0; a < fields.size(); ++a)
    for (std::size_t b = a + 1; b < fields.size(); ++b) {
      if (!share_a_node<T, D>(grid.sum(fields[a].block), grid.sum(fields[b].block))) continue;
      for (Field* field : {&fields[a], &fields[b]})
        if (field->masses.empty()) field->masses = masses_of(state, grid, field->block);
      const SharedNodes<T, D> nodes = find_shared_nodes<T, D>(fields[a].masses, fields[b].masses);
      ReachMap<T, D> first(nodes, T(1)), second(nodes, T(-1));  // towards each other
      find_reach(model, state, grid, fields[a].block, nodes, first);
      find_reach(model, state, grid, fields[b].block, nodes, second);
      for_each_index(nodes.begin, nodes.end, [&](const std::array<int, D>& node) {
        const int k = flat_index<D>(node, B);
        if (!nodes.contains(k)) return;
        EventContact<T> c{state.layout.grid_blocks[fields[a].block],
                          state.layout.grid_blocks[fields[b].block],
                          k,
                          fields[a].block,
                          fields[b].block,
                          first.at(node) >= -second.at(node),
                          {},
                          0,
                          0};
        for (int d = 0; d < D; ++d) c.normal[d] = nodes.normal[k][d];
        if (const EventContact<T>* old = before.find(c))
          c.impulse = c.next_impulse = old->next_impulse;
        if (c.touches || c.impulse > T(0)) contacts.push_back(c);
      });
    }
}

template <class T, int D>
void EventContacts<T, D>::exchange(const StepParameters<T>& step, double friction,
                                   State<T, D>& state, Grid<T, D>& grid,
                                   std::ptrdiff_t overlap) const {
  EventContact<T>* const end = state.event_contacts.data() + first_[overlap + 1];
  for (EventContact<T>* begin = state.event_contacts.data() + first_[overlap]; begin != end;) {
    EventContact<T>* const next = std::find_if(begin, end, [&](const EventContact<T>& c) {
      return c.first != begin->first || c.second != begin->second;
    });
    exchange(step, T(friction), grid, begin, next);
    begin = next;
  }
}

/// Exchanges the impulses between two fields. A part of the stored friction may suffice to stop a
/// node with little snow. The excess slows the nodes of the block that still slide.
template <class T, int D>
void EventContacts<T, D>::exchange(const StepParameters<T>& step, T friction, Grid<T, D>& grid,
                                   EventContact<T>* begin, EventContact<T>* end) const {
  if (!grid.touched[begin->first] || !grid.touched[begin->second]) {
    for (EventContact<T>* c = begin; c != end; ++c) c->next_impulse = 0;
    return;
  }
  const T* const sums[2] = {grid.sum(begin->first), grid.sum(begin->second)};
  T* const velocities[2] = {grid.velocity(begin->first), grid.velocity(begin->second)};
  EventImpulses<T, D> impulses[block_nodes<D>];
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
