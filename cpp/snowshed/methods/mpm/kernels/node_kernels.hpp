// The grid side of a step: sums from the tiles, velocities from the sums (thesis 1.2.9), contact.
#pragma once

#include <limits>

#include "snowshed/methods/mpm/energy_rule.hpp"
#include "snowshed/methods/mpm/kernels/node.hpp"
#include "snowshed/methods/mpm/kernels/tile.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

template <class T, int D, Basis basis, bool takes_change, bool energy>
struct NodeKernels {
  using Half = NodeHalf<T>;
  static constexpr T min_mass = min_node_mass<T>;

  static void gather(const T* const* tiles, T* sums) {
    std::memset(sums, 0, block_nodes<D> * node_values * sizeof(T));
    // Seen from the particle block, this block is the neighbour on the opposite side.
    const auto tile_of = [&](int neighbour) { return tiles[neighbour_count<D> - 1 - neighbour]; };
    const auto add = [&](int neighbour, int node, int tile_node, auto length) {
      T* out = sums + node * node_values;
      const T* in = tile_of(neighbour) + tile_node * node_values;
      for (int k = 0; k < length * node_values; ++k) out[k] += in[k];
    };
    for_each_shared_row<D, basis>(tile_of, add);
  }

  static void update(const StepParameters<T>& step, const T* sums, T* velocities,
                     Contact<T>* contacts, ContactForce<T>* forces, int contact_count,
                     const ContactLaw* laws, NodeStats& stats) {
    Range range;
    apply_forces(step, sums, velocities, range);
    constrain(step, sums, velocities, contacts, forces, contact_count, laws, stats, range);
    range.store(stats);
    if constexpr (energy) record_kinetic_energy(step, sums, velocities, stats);
  }

  static void update_free(const StepParameters<T>& step, const T* sums, T* velocities) {
    Range range;
    apply_forces(step, sums, velocities, range);
  }

  static void finish(const StepParameters<T>& step, const T* sums, T* velocities,
                     Contact<T>* contacts, ContactForce<T>* forces, int contact_count,
                     const ContactLaw* laws, NodeStats& stats) {
    Range range;
    for (int k = 0; k < block_nodes<D>; ++k)
      if (sums[k * node_values] > min_mass) range.add(load_half(velocities + k * node_values));
    constrain(step, sums, velocities, contacts, forces, contact_count, laws, stats, range);
    range.store(stats);
    if constexpr (energy) record_kinetic_energy(step, sums, velocities, stats);
  }

  static void carried_motion(const T* tile, int reach, const T* const* sums,
                             const T* const* velocities, SleepingBlockMotion& motion) {
    double mass = 0, change[D] = {}, squared = 0;
    const auto add = [&](int neighbour, int node, int tile_node, auto length) {
      for (int k = 0; k < length; ++k) {
        const double m = double(tile[(tile_node + k) * node_values]);
        mass += m;
        if (!sums[neighbour] || m == 0) continue;
        const T* sum = sums[neighbour] + (node + k) * node_values;
        const T* now = velocities[neighbour] + (node + k) * node_values;
        if (!(sum[0] > min_mass)) continue;
        const Half before = velocity(sum);
        for (int d = 0; d < D; ++d) {
          squared += m * double(now[d]) * double(now[d]);
          change[d] += m * (double(now[d]) - double(before[d]));
        }
      }
    };
    for_each_shared_row<D, basis>(touched_by<D>(reach), add);
    motion.speed_squared = squared / mass;
    for (int d = 0; d < D; ++d) motion.change[d] = change[d] / mass;
  }

 private:
  /// The smallest box that holds some velocities.
  struct Range {
    Half low = std::numeric_limits<T>::max() - Half{}, high = -low;

    SNOWSHED_INLINE void add(const Half& v) {
      low = v < low ? v : low;
      high = v > high ? v : high;
    }
    void store(NodeStats& stats) const {
      for (int d = 0; d < D; ++d) {
        stats.low[d] = double(low[d]);
        stats.high[d] = double(high[d]);
      }
    }
  };

  /// Applies forces and gravity.
  static SNOWSHED_INLINE void apply_forces(const StepParameters<T>& step, const T* sums,
                                           T* velocities, Range& range) {
    Half gravity{};
    gravity[D - 1] = -step.dt * step.gravity;
    for (int k = 0; k < block_nodes<D>; ++k) {
      const T* sum = sums + k * node_values;
      T* out = velocities + k * node_values;
      if (!(sum[0] > min_mass)) {
        std::memset(out, 0, node_values * sizeof(T));
        continue;
      }
      const Half old = velocity(sum);
      const Half now = old + load_half(sum + 4) * (step.dt / sum[0]) + gravity;
      store_velocity(out, now, old);
      range.add(now);
    }
  }

  /// Applies the conditions of obstacles.
  static SNOWSHED_INLINE void constrain(const StepParameters<T>& step, const T* sums, T* velocities,
                                        Contact<T>* contacts, ContactForce<T>* forces,
                                        int contact_count, const ContactLaw* laws, NodeStats& stats,
                                        Range& range) {
    Half total{};
    for (int c = 0; c < contact_count; ++c) {
      const T* sum = sums + contacts[c].node * node_values;
      T* out = velocities + contacts[c].node * node_values;
      const bool acts = contacts[c].acts || contacts[c].normal_impulse > T(0);
      if (sum[0] > min_mass && acts) {
        Half node = load_half(out);
        const Half free = node;
        apply(step, contacts[c], laws[contacts[c].obstacle], sum, node, stats);
        store_velocity(out, node, velocity(sum));
        range.add(node);
        if (forces) record(step, forces[c], sum[0] * (node - free), total);
      } else {
        contacts[c].next_normal_impulse = 0;
        if (forces) record(step, forces[c], Half{}, total);
      }
    }
    for (int d = 0; d < D; ++d) stats.impulse[d] = double(total[d]);
  }

  static SNOWSHED_INLINE void record(const StepParameters<T>& step, ContactForce<T>& force,
                                     const Half& impulse, Half& total) {
    if (step.holds_last)
      store_half(force.sum, Half(load_half(force.sum) + load_half(force.impulse)));
    store_half(force.impulse, impulse);
    total += impulse;
  }

  /// Velocity before the step; the fourth value is zero.
  static SNOWSHED_INLINE Half velocity(const T* sum) {
    const Half momentum = __builtin_shufflevector(load_half(sum), Half{}, 1, 2, 3, 4);
    return momentum / sum[0];
  }
  /// The second half gets the values that the particles' velocities take from the node.
  static SNOWSHED_INLINE void store_velocity(T* node, const Half& now, const Half& old) {
    store_half(node, now);
    store_half(node + 4, takes_change ? Half(now - old) : now);
  }

  static void record_kinetic_energy(const StepParameters<T>& step, const T* sums,
                                    const T* velocities, NodeStats& stats) {
    for (int k = 0; k < block_nodes<D>; ++k) {
      const T* in = sums + k * node_values;
      if (in[0] > min_mass)
        add_node_energy<D>(in[0], in + 1, in + 4, velocities + k * node_values, step.dt,
                           stats.energy);
    }
  }

  /// Returns the coefficient of friction at a sliding speed and a normal impulse of the step.
  static T coefficient(const StepParameters<T>& step, const ContactLaw& law, T speed, T impulse) {
    if (!law.coefficient) return T(law.friction);
    double area = 1;
    for (int d = 1; d < D; ++d) area *= double(step.dx);
    const double given = law.coefficient(double(speed), double(impulse) / (double(step.dt) * area));
    // No friction is negative. A value that is not finite is found by the check of the particles.
    return given >= 0 ? T(given) : std::numeric_limits<T>::quiet_NaN();
  }

  /// Applies the condition of an obstacle (sticky, slip or separate) to a node.
  static void apply(const StepParameters<T>& step, Contact<T>& c, const ContactLaw& law,
                    const T* sum, Half& node, NodeStats& stats) {
    NodeMotion<T, D> motion;
    motion.mass = sum[0];
    for (int d = 0; d < D; ++d) {
      motion.impulse[d] = double(step.dt) * double(sum[4 + d]);
      motion.before[d] = sum[1 + d] / sum[0];
      motion.free[d] = node[d];
    }
    if (law.condition == Condition::sticky) {
      for (int d = 0; d < D; ++d) node[d] = motion.after[d] = c.velocity[d];
      if constexpr (energy) add_sticking(motion, stats.energy);
      return;
    }
    const auto coefficient_at = [&](T speed, T impulse) {
      return coefficient(step, law, speed, impulse);
    };
    const FrictionRates<T> rates{step.friction_rate, step.friction_rate_per_speed};
    const ContactOutcome<T> outcome =
        push_and_rub<D>(rates, c, sum[0], step.friction_shares[c.obstacle], coefficient_at, node);
    for (int d = 0; d < D; ++d) motion.after[d] = node[d];
    if constexpr (energy) add_push_and_rub(motion, c.normal, outcome, stats.energy);
  }
};

SNOWSHED_MODULE_VARIANT_END
