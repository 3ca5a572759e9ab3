// The grid side of a step: sums from the tiles, velocities from the sums (thesis 1.2.9), contact.
#pragma once

#include <limits>

#include "mpm/kernels/chunk.hpp"
#include "mpm/kernels/tile.hpp"

SNOWSHED_VARIANT_BEGIN

template <class T, int D, Basis basis, bool flip, bool energy>
struct NodeKernels {
  static void gather(const T* const* tiles, T* sums) {
    std::memset(sums, 0, block_nodes<D> * node_values * sizeof(T));
    Node<T>* out = reinterpret_cast<Node<T>*>(sums);
    for_each_shared_row<D, basis>([&](int neighbour, int node, int tile_node, int length) {
      // Seen from the particle block this block is the neighbour on the opposite side.
      const T* tile = tiles[neighbour_count<D> - 1 - neighbour];
      if (!tile) return;
      const Node<T>* in = reinterpret_cast<const Node<T>*>(tile);
      for (int k = 0; k < length; ++k) out[node + k] += in[tile_node + k];
    });
  }

  static void update(const StepParameters<T>& step, const T* sums, T* velocities,
                     Contact<T>* contacts, int contact_count, const ContactLaw* laws,
                     NodeStats& stats) {
    const Node<T>* in = reinterpret_cast<const Node<T>*>(sums);
    Node<T>* out = reinterpret_cast<Node<T>*>(velocities);
    Node<T> gravity{};
    gravity[D - 1] = -step.dt * step.gravity;
    for (int k = 0; k < block_nodes<D>; ++k) {
      const Node<T> sum = in[k];
      const T inverse = sum[0] > T(0) ? T(1) / sum[0] : T(0);
      Node<T> node = {(sum[1] + step.dt * sum[4]) * inverse,
                      (sum[2] + step.dt * sum[5]) * inverse,
                      (sum[3] + step.dt * sum[6]) * inverse, 0, 0, 0, 0, 0};
      if (sum[0] > T(0)) node += gravity;
      out[k] = node;
    }
    for (int c = 0; c < contact_count; ++c) {
      Contact<T>& contact = contacts[c];
      Node<T>& node = out[contact.node];
      const T mass = in[contact.node][0];
      if (mass > T(0))
        apply(contact, laws[contact.obstacle], mass, node, stats);
      else
        contact.next_debt = 0;
    }
    finish(in, out, stats);
  }

 private:
  /// Second half of each node: what the particles' velocities take from it; and the bounds.
  static void finish(const Node<T>* in, Node<T>* out, NodeStats& stats) {
    T low[D], high[D];
    for (int d = 0; d < D; ++d) {
      low[d] = std::numeric_limits<T>::max();
      high[d] = -low[d];
    }
    for (int k = 0; k < block_nodes<D>; ++k) {
      const T mass = in[k][0];
      Node<T> node = out[k];
      const T inverse = mass > T(0) ? T(1) / mass : T(0);
      for (int d = 0; d < D; ++d) node[4 + d] = flip ? node[d] - in[k][1 + d] * inverse : node[d];
      out[k] = node;
      if (!(mass > T(0))) continue;
      for (int d = 0; d < D; ++d) {
        low[d] = node[d] < low[d] ? node[d] : low[d];
        high[d] = node[d] > high[d] ? node[d] : high[d];
      }
      if constexpr (energy) {
        for (int d = 0; d < D; ++d) {
          stats.kinetic_before += 0.5 * double(in[k][1 + d]) * double(in[k][1 + d]) / double(mass);
          stats.kinetic_after += 0.5 * double(mass) * double(node[d]) * double(node[d]);
        }
      }
    }
    for (int d = 0; d < D; ++d) {
      stats.low[d] = double(low[d]);
      stats.high[d] = double(high[d]);
    }
  }

  static double kinetic(const Node<T>& v, T mass) {
    double sum = 0;
    for (int d = 0; d < D; ++d) sum += double(v[d]) * double(v[d]);
    return 0.5 * double(mass) * sum;
  }

  /// STICKY, SLIP, SEPARATE (thesis 1.2.3). Coulomb friction acts on the net normal impulse: a
  /// SLIP node that had to pull remembers the pull as a debt, and friction is charged only for
  /// push beyond it. Charging every push instead (the usual rule) overestimates the friction of
  /// a slab that vibrates on its panel, up to holding it where it should slide.
  static void apply(Contact<T>& c, const ContactLaw& law, T mass, Node<T>& node, NodeStats& stats) {
    c.next_debt = c.debt;
    const double before = energy ? kinetic(node, mass) : 0;
    if (law.condition == Condition::sticky) {
      for (int d = 0; d < D; ++d) node[d] = c.velocity[d];
      if constexpr (energy) stats.sticking += before - kinetic(node, mass);
      return;
    }
    T relative[D], normal_speed = 0;
    for (int d = 0; d < D; ++d) {
      relative[d] = node[d] - c.velocity[d];
      normal_speed += relative[d] * c.normal[d];
    }
    if (normal_speed >= T(0) && !c.holds) return;
    const T push = -mass * normal_speed;
    const T unpaid = c.debt - push;
    c.next_debt = c.holds && unpaid > T(0) ? unpaid : T(0);
    const T charged = unpaid < T(0) ? -unpaid : T(0);
    T tangential = 0;
    for (int d = 0; d < D; ++d) {
      relative[d] -= normal_speed * c.normal[d];
      tangential += relative[d] * relative[d];
    }
    const double between = energy ? before - 0.5 * double(mass) * double(normal_speed) * double(normal_speed) : 0;
    tangential = std::sqrt(tangential);
    const T loss = T(law.friction) * charged;
    const T keep = tangential * mass > loss ? T(1) - loss / (tangential * mass) : T(0);
    for (int d = 0; d < D; ++d) node[d] = c.velocity[d] + relative[d] * keep;
    if constexpr (energy) {
      stats.impact += before - between;
      stats.friction += between - kinetic(node, mass);
    }
  }
};

SNOWSHED_VARIANT_END
