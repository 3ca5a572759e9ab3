// The energy of a particle's strain, and the energy that a contact takes. A graphics card compiles
// this file, too.
#pragma once

#include "snowshed/methods/mpm/contact_rule.hpp"
#include "snowshed/methods/mpm/step_energies.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Pressure and Mises stress, Pa.
struct StressInvariants {
  double p, q;
};

/// Adds the elastic energy p^2/(2 K_d) + q^2/(6 mu) per initial volume, and the plastic work of the
/// return from `trial`, stress times plastic strain. (The loss of elastic energy from the trial
/// would also contain the square of each step's plastic strain. This error adds up over the steps.)
inline void add_strain_energy(double volume, double bulk, double mu, const StressInvariants& trial,
                              const StressInvariants& now, ParticleEnergies& e) {
  const double p = now.p, q = now.q;
  e.elastic += volume * (p * p / (2 * bulk) + q * q / (6 * mu));
  e.plastic += volume * (p * (trial.p - p) / bulk + q * (trial.q - q) / (3 * mu));
}

/// The motion of a node in a step: its mass (kg), the stresses' impulse (N s), and its velocity
/// (m/s) before the step, without the contact, and after it.
template <class T, int D>
struct NodeMotion {
  T mass;
  double impulse[D];
  T before[D], free[D], after[D];
};

/// Adds the kinetic energies of a node, and the work of its stresses at the velocity before the
/// step.
template <int D, class T>
void add_node_energy(T node_mass, const T* momentum, const T* force, const T* after, T dt,
                     NodeEnergies& e) {
  const double mass = double(node_mass);
  for (int d = 0; d < D; ++d) {
    e.kinetic_before += 0.5 * double(momentum[d]) * double(momentum[d]) / mass;
    e.kinetic_after += 0.5 * mass * double(after[d]) * double(after[d]);
    e.stress_work += double(dt) * double(force[d]) * double(momentum[d]) / mass;
  }
}

/// Returns the energy lost in a contact that set the velocity of a node, or one component of it.
/// Over the step the node's velocity went from `before` to `after`; without the contact it would
/// have been `free`. Particles move with `after`, so that stresses and gravity did the work m
/// (free - before) . after. The contact took the part of this work that did not become kinetic
/// energy.
template <class T, int D>
double loss_by_holding(T mass, const T (&before)[D], const T (&free)[D], const T (&after)[D]) {
  double sum = 0;
  for (int d = 0; d < D; ++d) {
    const double b = double(before[d]), f = double(free[d]), a = double(after[d]);
    sum += (f - b) * a + 0.5 * (b * b - a * a);
  }
  return double(mass) * sum;
}

/// The same for a contact with a bounded impulse, in which the node still reacts to the stresses.
/// The energy lost is minus the work of the impulse at the mean velocity.
template <class T, int D>
double loss_by_impulse(T mass, const T (&before)[D], const T (&free)[D], const T (&after)[D]) {
  double work = 0;
  for (int d = 0; d < D; ++d)
    work += 0.5 * (double(after[d]) - double(free[d])) * (double(before[d]) + double(after[d]));
  return -double(mass) * work;
}

/// Returns the work of a node's stresses in the change of a velocity.
template <class T, int D>
double work_in_change(const double (&impulse)[D], const T (&from)[D], const T (&to)[D]) {
  double sum = 0;
  for (int d = 0; d < D; ++d) sum += impulse[d] * (double(to[d]) - double(from[d]));
  return sum;
}

/// Adds the energy that a sticky contact takes.
template <class T, int D>
void add_sticking(const NodeMotion<T, D>& m, NodeEnergies& e) {
  e.sticking += loss_by_holding(m.mass, m.before, m.free, m.after);
  e.stress_work += work_in_change(m.impulse, m.before, m.after);
}

/// The parts of a vector along a normal and across it.
template <class T, int D>
struct NormalSplit {
  T normal[D], tangential[D];
  NormalSplit(const T (&v)[D], const T (&n)[3]) {
    T along = 0;
    for (int d = 0; d < D; ++d) along += v[d] * n[d];
    for (int d = 0; d < D; ++d) {
      normal[d] = along * n[d];
      tangential[d] = v[d] - normal[d];
    }
  }
};

/// Adds the energy that a contact with slip or separate takes.
template <class T, int D>
void add_push_and_rub(const NodeMotion<T, D>& m, const T (&normal)[3],
                      const ContactOutcome<T>& outcome, NodeEnergies& e) {
  const NormalSplit<T, D> before(m.before, normal), free(m.free, normal), after(m.after, normal);
  if (outcome.lets_go) {
    e.impact += loss_by_impulse(m.mass, before.normal, free.normal, after.normal);
  } else {
    e.impact += loss_by_holding(m.mass, before.normal, free.normal, after.normal);
    e.stress_work += work_in_change(m.impulse, before.normal, after.normal);
  }
  if (outcome.slip_share == T(1)) {
    e.stress_work += work_in_change(m.impulse, before.tangential, after.tangential);
    e.friction += loss_by_holding(m.mass, before.tangential, free.tangential, after.tangential);
  } else {
    e.friction += loss_by_impulse(m.mass, before.tangential, free.tangential, after.tangential);
  }
}

/// Adds the energy that two impulses (N s) between the snow of two events take from one of them.
/// `after` is the node's velocity after both, along the same direction.
inline void add_exchange(double mass, double momentum, double pushed, double rubbed, double after,
                         NodeEnergies& e) {
  const double mean = 0.5 * (momentum / mass + after);
  e.impact -= mass * pushed * mean;
  e.friction -= mass * rubbed * mean;
}

SNOWSHED_MODULE_VARIANT_END
