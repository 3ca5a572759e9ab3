// The contract between a method and what runs it: particles are added and removed, steps are taken,
// fields and energies are read, and the state is saved and restored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/energy_balance.hpp"

namespace snowshed {

class BinaryWriter;
class BinaryReader;

/// Particles to add: equal masses, one velocity, one kind of snow.
struct ParticleBatch {
  std::vector<Vec3> positions;   // m
  Vec3 velocity = Vec3::Zero();  // m/s
  double mass = 0;               // kg each (per metre of width in 2D)
  int event = 1;
  int material_id = 0;
};

/// A copy of the particles for the outside, in double, ordered by id.
struct ParticleState {
  std::vector<Vec3> positions, velocities;  // m, m/s
  std::vector<double> masses;               // kg
  std::vector<double> volume_ratios;        // current over initial volume
  std::vector<double> densities;            // kg/m3, current
  std::vector<double> plastic_strains;      // volumetric, compaction negative
  std::vector<double> pressures;            // Kirchhoff, Pa, compression positive
  std::vector<Mat3> affine;                 // APIC's C, 1/s; empty with FLIP
  std::vector<std::uint32_t> ids;
  std::vector<std::uint16_t> events;
  std::vector<std::uint8_t>
      material_ids;  // which of the snows each is; empty where there is only one
};

/// How much the snow moves.
struct MotionSummary {
  double mass = 0;         // kg
  double rms_speed = 0;    // m/s
  double moving_mass = 0;  // kg faster than the given speed
};

/// Counters since the solver was made.
struct StepCounters {
  std::int64_t steps = 0, rejected = 0, sorts = 0;
  std::int64_t particle_updates = 0;  // of particles that were awake
  std::int64_t slept_updates = 0;     // that sleeping particles did not need
  double smallest_dt = 0;             // s
};

/// What a method is to the rest of the program. Dimension and precision are chosen once, where the
/// method is made.
class Method {
 public:
  virtual ~Method() = default;

  virtual void add(const ParticleBatch&) = 0;
  /// Adds all particles of several batches, in their order, or none of them.
  virtual void add(const std::vector<ParticleBatch>&) = 0;
  /// Puts the particles of several batches in place of all there are, or leaves these as they are.
  virtual void replace(const std::vector<ParticleBatch>&) = 0;
  virtual void clear() = 0;  ///< removes all particles

  /// Adds to the velocity of each particle, ordered by id; the energy books count it as added.
  virtual void add_velocity(const std::vector<Vec3>& velocity_changes) = 0;

  /// Lowers each particle, ordered by id, by a height (m) and adds to its volumetric plastic
  /// strain, if its law has one. Elastic strains and velocities stay. The energy books count it as
  /// added.
  virtual void settle(const std::vector<double>& drops,
                      const std::vector<double>& plastic_changes) = 0;

  /// One step. Throws SimulationError when it cannot go on; the particles are then as they were
  /// before the step, except after "not finite".
  virtual void step() = 0;

  /// Whether the state is only the particles, so that a checkpoint taken now resumes to the same
  /// bits. True before every sort: at least once in `steps_between_sorts` steps.
  virtual bool at_safe_point() const = 0;

  virtual std::size_t size() const = 0;
  virtual double time() const = 0;       ///< s
  virtual double time_step() const = 0;  ///< s, of the last step
  virtual const StepCounters& counters() const = 0;
  virtual ParticleState state() const = 0;
  virtual MotionSummary motion(double speed) const = 0;
  virtual EnergyBalance energy() const = 0;
  virtual std::size_t bytes() const = 0;  ///< held by particles and grid

  virtual void save(BinaryWriter&) const = 0;
  virtual void load(const BinaryReader&) = 0;
};

}  // namespace snowshed
