#include "snowshed/methods/mpm/event_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/methods/mpm/index_box.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Returns the flat index in an array with `edge` elements along each direction, whose indices
/// begin at `low`.
template <int D>
int flat_index(const std::array<int, D>& index, int edge, int low = 0) {
  int flat = 0;
  for (int d = 0; d < D; ++d) flat = flat * edge + index[d] - low;
  return flat;
}

template <class T>
bool by_key(const EventContact<T>* a, const EventContact<T>* b) {
  return a->key() < b->key();
}

}  // namespace

template <class T, int D>
void EventContacts<T, D>::forget(const Model<T, D>& model, const State<T, D>& state, int threads) {
  measured_ = false;
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
                                 double moved, int threads) {
  since_measured_ += moved;
  if (measured_ && since_measured_ < contact_tolerance * model.options.settings.dx) return;
  const std::vector<EventContact<T>>& before = state.event_contacts;
  SortedContacts contacts_by_key;
  for (const EventContact<T>& c : before) contacts_by_key.push_back(&c);
  std::sort(contacts_by_key.begin(), contacts_by_key.end(), by_key<T>);
  std::vector<std::vector<EventContact<T>>> by_overlap(overlap_count(state.layout));
  parallel_for_dynamic(overlap_count(state.layout), threads, 1, [&](std::ptrdiff_t overlap) {
    const std::int32_t block = state.layout.overlap_blocks[state.layout.overlap_first[overlap]];
    if (measured_ && !state.sleep.is_active(block))  // nothing has moved there
      by_overlap[overlap].assign(before.begin() + first_[overlap],
                                 before.begin() + first_[overlap + 1]);
    else
      measure(model, state, grid, contacts_by_key, overlap, by_overlap[overlap]);
  });
  std::vector<EventContact<T>> next;
  std::vector<std::int32_t> first{0};
  for (const auto& contacts : by_overlap) {
    next.insert(next.end(), contacts.begin(), contacts.end());
    first.push_back(std::int32_t(next.size()));
  }
  state.event_contacts = std::move(next);
  first_ = std::move(first);
  since_measured_ = 0;
  measured_ = true;
}

/// The sums of a block of nodes, or null if no snow reaches it. `buffer` holds them if the block
/// takes no part in the step.
template <class T, int D>
const T* EventContacts<T, D>::sums_of(const State<T, D>& state, Grid<T, D>& grid,
                                      const Kernels<T>& kernels, std::int32_t g,
                                      std::vector<T>& buffer) const {
  if (state.sleep.is_active(g)) return grid.touched[g] ? grid.sum(g) : nullptr;
  const T* tiles[neighbour_count<D>];
  if (!grid.tiles_reaching(state.layout, g, tiles)) return nullptr;
  buffer.resize(Grid<T, D>::block_size);
  kernels.gather(tiles, buffer.data());
  return buffer.data();
}

template <class T, int D>
typename EventContacts<T, D>::Masses EventContacts<T, D>::masses_of(const State<T, D>& state,
                                                                    Grid<T, D>& grid,
                                                                    const Kernels<T>& kernels,
                                                                    std::int32_t g) const {
  Masses masses(padded_nodes, T(0));
  std::vector<T> buffer;
  const BlockKey key = state.layout.grid_blocks[g];
  for_each_index(filled(-1), filled(2), [&](const std::array<int, D>& offset) {
    BlockCoord<D> coord = block_coord<D>(key);
    std::array<int, D> begin, end;
    for (int d = 0; d < D; ++d) {
      coord[d] += offset[d];
      begin[d] = offset[d] < 0 ? B - margin : 0;
      end[d] = offset[d] > 0 ? margin : B;
    }
    const std::int32_t block =
        find_block(state.layout.grid_blocks, block_key<D>(coord, field_of(key)));
    if (block < 0) return;
    const T* sums = sums_of(state, grid, kernels, block, buffer);
    if (!sums) return;
    for_each_index(begin, end, [&](const std::array<int, D>& node) {
      std::array<int, D> padded;
      for (int d = 0; d < D; ++d) padded[d] = node[d] + offset[d] * B;
      masses[flat_index<D>(padded, padded_edge, -margin)] =
          sums[flat_index<D>(node, B) * node_values];
    });
  });
  return masses;
}

/// Finds the normals of the nodes, smoothed over the nodes around each. Without smoothing their
/// directions are arbitrary at the corners of a body, and they would push the body forward.
template <class T, int D>
void EventContacts<T, D>::find_normals(const Masses& a, const Masses& b, Nodes& nodes) {
  struct WeightedNormal {
    std::array<int, D> node;
    double normal[D];  // see find_weighted_normal
  };
  std::vector<WeightedNormal> around;
  const auto shared = [&](int k) { return is_shared(a[k], b[k]); };
  for_each_index(filled(-smoothing), filled(B + smoothing), [&](const std::array<int, D>& node) {
    const int k = flat_index<D>(node, padded_edge, -margin);
    WeightedNormal weighted{node, {}};
    if (shared(k) && find_weighted_normal(a.data() + k, b.data() + k, padded_edge, weighted.normal))
      around.push_back(weighted);
  });
  if (around.empty()) return;
  for_each_index(filled(0), filled(B), [&](const std::array<int, D>& node) {
    if (!shared(flat_index<D>(node, padded_edge, -margin))) return;
    VecD<D> sum = VecD<D>::Zero();
    for (const WeightedNormal& other : around) {
      int distance[D];
      for (int d = 0; d < D; ++d) distance[d] = other.node[d] - node[d];
      const double weight = smoothing_weight(distance);
      for (int d = 0; d < D; ++d) sum[d] += weight * other.normal[d];
    }
    const double length = sum.norm();
    if (!(length > 0)) return;
    const int k = flat_index<D>(node, B);
    nodes.shared |= std::uint64_t(1) << k;
    for (int d = 0; d < D; ++d) {
      nodes.normal[k][d] = T(sum[d] / length);
      nodes.begin[d] = std::min(nodes.begin[d], node[d]);
      nodes.end[d] = std::max(nodes.end[d], node[d] + 1);
    }
    nodes.first[k] = T(-1e9);
    nodes.second[k] = T(1e9);
  });
}

/// Finds how far the particles of a field, with their radius, reach along the normals of the nodes.
/// Only particles that have weight at a node count.
template <class T, int D>
void EventContacts<T, D>::find_reach(const Model<T, D>& model, const State<T, D>& state,
                                     std::int32_t g, bool first, Nodes& nodes) const {
  const Particles<T, D>& p = state.particles;
  const BlockCoord<D> block = block_coord<D>(state.layout.grid_blocks[g]);
  const T offset = T(base_offset(model.options.settings.basis));
  for (const std::int32_t b : state.layout.around_nodes[g]) {
    if (b < 0) continue;
    const BlockCoord<D> from = block_coord<D>(state.layout.particle_blocks[b]);
    for (std::int32_t i = state.layout.first[b]; i < state.layout.first[b + 1]; ++i) {
      T x[D];
      std::array<int, D> begin, end;
      bool near = true;
      for (int d = 0; d < D; ++d) {
        const T cell = p.cell[d][i] + T((from[d] - block[d]) * B);
        const int lowest = int(std::floor(cell));
        x[d] = cell + offset;
        begin[d] = std::max(lowest, nodes.begin[d]);
        end[d] = std::min(lowest + support_, nodes.end[d]);
        near = near && begin[d] < end[d];
      }
      if (!near) continue;
      for_each_index(begin, end, [&](const std::array<int, D>& node) {
        const int k = flat_index<D>(node, B);
        if (!(nodes.shared >> k & 1)) return;
        T along = 0;
        for (int d = 0; d < D; ++d) along += x[d] * nodes.normal[k][d];
        if (first)
          nodes.first[k] = std::max(nodes.first[k], along + radius_[i]);
        else
          nodes.second[k] = std::min(nodes.second[k], along - radius_[i]);
      });
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
  std::vector<T> buffer;
  std::vector<std::int32_t> reached;
  for (auto g = begin; g != end; ++g)
    if (sums_of(state, grid, model.kernels, *g, buffer)) reached.push_back(*g);
  if (reached.size() < 2) return;
  std::vector<Masses> masses;
  for (const std::int32_t g : reached) masses.push_back(masses_of(state, grid, model.kernels, g));
  for (std::size_t a = 0; a < reached.size(); ++a)
    for (std::size_t b = a + 1; b < reached.size(); ++b) {
      Nodes nodes;
      find_normals(masses[a], masses[b], nodes);
      if (!nodes.shared) continue;
      find_reach(model, state, reached[a], true, nodes);
      find_reach(model, state, reached[b], false, nodes);
      for (int k = 0; k < block_nodes<D>; ++k) {
        if (!(nodes.shared >> k & 1)) continue;
        EventContact<T> c{state.layout.grid_blocks[reached[a]],
                          state.layout.grid_blocks[reached[b]],
                          k,
                          reached[a],
                          reached[b],
                          nodes.first[k] >= nodes.second[k],
                          {},
                          0,
                          0};
        for (int d = 0; d < D; ++d) c.normal[d] = nodes.normal[k][d];
        const auto old = std::lower_bound(before.begin(), before.end(), &c, by_key<T>);
        if (old != before.end() && (*old)->key() == c.key())
          c.impulse = c.next_impulse = (*old)->next_impulse;
        if (c.touches || c.impulse > T(0)) contacts.push_back(c);
      }
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
  NodeStats& stats = grid.node_stats[begin->first];
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
        const double mean =
            0.5 * (double(sum[1 + d]) / double(sum[0]) + double(node[d] + pushed + rubbed));
        stats.impact -= double(sum[0]) * double(pushed) * mean;
        stats.friction -= double(sum[0]) * double(rubbed) * mean;
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
