// The energies of a step, as sums over particles and nodes. A graphics card compiles this file,
// too.
#pragma once

namespace snowshed::methods::mpm {

/// Energies of particles after a step.
struct ParticleEnergies {
  double kinetic, elastic;  // J
  double plastic;           // J, plastic work of the step
  double damping;           // J, kinetic energy that damping towards the average took
  double stress_power;      // W, power of the new stresses in the motion of this step

  ParticleEnergies& operator+=(const ParticleEnergies& other) {
    kinetic += other.kinetic;
    elastic += other.elastic;
    plastic += other.plastic;
    damping += other.damping;
    stress_power += other.stress_power;
    return *this;
  }
};

/// Energies of nodes in a step, J.
struct NodeEnergies {
  double kinetic_before, kinetic_after;  // before forces, after contact
  double friction, sticking, impact;     // energy that contact took
  double stress_work;                    // by the stresses at the velocities before the step

  NodeEnergies& operator+=(const NodeEnergies& other) {
    kinetic_before += other.kinetic_before;
    kinetic_after += other.kinetic_after;
    friction += other.friction;
    sticking += other.sticking;
    impact += other.impact;
    stress_work += other.stress_work;
    return *this;
  }
};

/// Energies of a step that was taken.
struct StepEnergies {
  double dt;  // s
  ParticleEnergies particles;
  NodeEnergies nodes;
};

}  // namespace snowshed::methods::mpm
