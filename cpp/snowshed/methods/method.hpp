// The contract between a method and its callers: particles are added and replaced, steps are taken,
// fields are read, and the state is saved and restored. Capabilities of some methods, such as
// settling, are in capabilities.hpp.
//
// Promises of every method:
// - A call that throws leaves the snow, the time, the counters and the energies as they were, so
//   that the caller may repeat it or make another call. Data read by id are the same; only the
//   order of the particles in memory may differ. This holds for lack of memory, too.
// - One exception: `step` can find only afterwards that a particle is no longer sound. Then the
//   step has been taken and the method has *failed*: it can still be read, but every call that
//   would alter, advance or save it throws SimulationError, so that a broken state never
//   overwrites a good checkpoint. `load` repairs it.
// - Errors: InputError for arguments that are not allowed, SimulationError if the simulation
//   cannot continue, std::bad_alloc for lack of memory.
// - The results do not depend on the number of threads, to the last bit.
//
// Particles have ids, in the order in which they were added. For callers they are ordered by id;
// their order in memory is the method's own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/methods/particle_batch.hpp"
#include "snowshed/methods/point_cloud.hpp"
#include "snowshed/particles/field_view.hpp"

namespace snowshed::io {
class BinaryWriter;
class BinaryReader;
}  // namespace snowshed::io

namespace snowshed::methods {

/// A copy of the particles in double precision, ordered by id: the quantities that every method
/// has. `values_by_id` (fields_by_id.hpp) returns any other.
struct ParticleState {
  std::vector<Vec3> positions, velocities;  // m, m/s
  std::vector<double> masses;               // kg
  std::vector<double> densities;            // kg/m3, current
  std::vector<std::uint32_t> ids;
  std::vector<std::uint16_t> events;
  std::vector<std::uint8_t> material_ids;  // snow of each particle; empty if there is only one
};

/// Motion of the snow as a whole.
struct MotionSummary {
  double mass = 0;         // kg
  double rms_speed = 0;    // m/s
  double moving_mass = 0;  // kg of snow faster than the given speed
};

/// Counters since the method was made.
struct StepCounters {
  std::int64_t steps = 0, rejected = 0;
  std::int64_t particle_updates = 0;  // particles that took part, summed over the steps
  double smallest_dt = 0;             // s
};

/// The contract of a method; the top of this file describes a call that throws.
/// Dimension and precision are chosen once, where the method is made.
class Method {
 public:
  virtual ~Method() = default;

  // --- the snow; between steps -----------------------------------------------------------------

  /// Adds the particles of all batches, or none. The energy balance counts their energy as added.
  /// Throws InputError for a batch that the scene does not allow, SimulationError if a position
  /// lies outside the space that the method can address, and Stopped on request if it takes long.
  virtual void add(const std::vector<ParticleBatch>& batches, const StopRequest& stop) = 0;
  void add(const std::vector<ParticleBatch>& batches) { add(batches, {}); }
  void add(const ParticleBatch& batch) { add(std::vector<ParticleBatch>{batch}); }

  /// Removes all particles and adds those of the batches, or leaves all as it is. New particles get
  /// new ids; the time continues. The energy balance counts the energy that comes and goes as
  /// added, with its sign. Throws as `add`.
  virtual void replace(const std::vector<ParticleBatch>& batches) = 0;

  /// Adds to the velocity of each particle, ordered by id (m/s); the energy balance counts it as
  /// added. Throws InputError unless there is one finite change per particle.
  virtual void add_velocity(const std::vector<Vec3>& velocity_changes) = 0;

  // --- time ------------------------------------------------------------------------------------

  /// Takes one step, of a length that the method chooses. Throws SimulationError if there is no
  /// snow, if the time step falls to zero, or if a particle is lost; the state is then as it was.
  /// Throws SimulationError, too, if a particle is not finite or strained beyond the resolution;
  /// the method has then failed (see the top).
  virtual void step() = 0;

  /// Takes steps until a time (s) is reached, or none if it has passed. The method chooses the
  /// length of its steps, so the last one ends up to a step later. Throws as `step`; the steps
  /// before remain taken.
  virtual void advance(double until) {
    while (time() < until) step();
  }

  /// Whether `save` writes all data on which later steps depend, so that a checkpoint taken now
  /// resumes to the same bits. A checkpoint taken at another time is valid, too, but resumes to
  /// results that differ in the last bits. A method is at a safe point again after a bounded number
  /// of steps.
  virtual bool at_safe_point() const = 0;

  /// Whether the snow has come to rest, if the method has a criterion of its own; without one the
  /// caller decides.
  virtual std::optional<bool> at_rest() const { return std::nullopt; }

  /// The finished part of an event, 0 to 1, if the method has a better measure than the time.
  virtual std::optional<double> progress() const { return std::nullopt; }

  virtual double time() const = 0;       ///< s
  virtual double time_step() const = 0;  ///< s, of the last step
  virtual const StepCounters& counters() const = 0;

  /// The readable quantities of the particles, and whether each is stored.
  virtual std::vector<particles::FieldInfo> fields() const = 0;
  /// The quantity of this name, in the order of storage: a view of memory if it is stored,
  /// otherwise a copy computed now. Throws InputError if there is no such field.
  virtual particles::FieldView field(const std::string& name) const = 0;
  /// The storage index of each particle, ordered by id.
  virtual const std::vector<std::uint32_t>& order_by_id() const = 0;

  // --- state and motion of the snow; allowed after a failure, too ------------------------------

  virtual std::size_t size() const = 0;  ///< particles
  virtual ParticleState state() const = 0;
  virtual MotionSummary motion(double speed) const = 0;  ///< snow above `speed`, m/s, is moving
  /// Memory of the particles and of the largest arrays that the steps need.
  virtual std::size_t bytes() const = 0;

  /// Contents of a file of particles, ordered by id: by default the quantities of `state`, and the
  /// stresses and strains among the fields.
  virtual PointCloud snapshot() const;

  // --- checkpoints -----------------------------------------------------------------------------

  /// Adds the state to an archive, whose sections may refer to the method's memory until it is
  /// written: no other call is allowed until then. Throws SimulationError if the method has failed.
  virtual void save(io::BinaryWriter&) const = 0;

  /// Replaces the state by that of an archive. The archive must come from the same scene, or from
  /// one that had only the first of its snows. Throws InputError if the archive is not sound.
  virtual void load(const io::BinaryReader&) = 0;

  /// Makes the checks of `load` and throws as `load`, but changes nothing and needs less memory.
  virtual void check(const io::BinaryReader&) const = 0;
};

}  // namespace snowshed::methods
