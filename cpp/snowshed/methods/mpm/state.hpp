// The state that steps change and checkpoints hold. The workspace has the data that can be computed
// from it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/methods/mpm/boundary.hpp"
#include "snowshed/methods/mpm/event_contact.hpp"
#include "snowshed/methods/mpm/model.hpp"
#include "snowshed/methods/mpm/particle_sort.hpp"
#include "snowshed/methods/mpm/sleep.hpp"
#include "snowshed/methods/obstacle_forces.hpp"

namespace snowshed::methods::mpm {

/// Part of a cell that snow may move before its contacts by touch are found again.
inline constexpr double contact_tolerance = 0.02;

/// The scalar values of a state. They are cheap to copy, so that a step that fails can restore
/// them.
struct StepTotals {
  double time = 0, dt = 0;  // s; dt is that of the last step
  double speed = 0;         // m/s, of the fastest particle
  double stress_power = 0;  // W, see `add_step`
  std::uint32_t next_id = 0;
  StepCounters counters;
  std::int64_t sorts = 0;  // sorts of the particles by blocks
  std::int64_t slept_updates = 0;
  // Number and time of the steps since velocities were last damped over a length.
  std::int64_t undamped_steps = 0;
  double undamped_time = 0;  // s
  EnergyBalance energy;      // the gravitational part as it was when snow was last added
};

/// Adds a step that was taken to the balance of energy.
void add_step(StepTotals& totals, const StepEnergies& step) noexcept;

/// The record of forces. Sleeping snow takes part in no step, so it goes on pressing with its
/// contacts' mean forces.
struct ForceRecord {
  ObstacleForces forces;
  std::vector<ContactImpulse> held;  // N, forces of sleeping snow by name of the obstacles
  double collected = 0;              // s, time of the last collection
  bool slept = false;                // whether any snow slept since the balance began
};

template <class T, int D>
struct State {
  explicit State(const Model<T, D>& model);

  Particles<T, D> particles;
  BlockLayout<D> layout;
  Contacts<T, D> contacts;
  // Contacts between fields, valid after EventContacts has updated them.
  std::vector<EventContact<T>> event_contacts;
  Sleep<D> sleep;
  StepTotals totals;
  std::optional<ForceRecord> forces;  // if the options ask for it

  std::map<int, int> event_fields;  // field of each event

  // Limits of the snows that are present, or of all snows while there are no particles.
  double elastic_limit = 0;    // s, time step of the stiffest
  double friction_memory = 0;  // s, from the snow with the slowest waves

  /// Appends particles, and the block of each to `blocks`. Throws InputError if the batch does not
  /// fit the model, and SimulationError if a position is outside the addressable grid.
  void append(const Model<T, D>& model, const ParticleBatch& batch, std::vector<BlockKey>& blocks);

  /// Puts a particle at a position (m). Returns the block in which it lies.
  BlockKey put(const Model<T, D>& model, std::size_t particle, const VecD<D>& position, int field);

  /// Sorts the particles, which lie in `blocks`, and updates the layout, the contacts and the
  /// sleep. If this throws, nothing has changed.
  void arrange(const Model<T, D>& model, std::vector<BlockKey> blocks);

  /// Adopts the layout of particles that `sort` brings into its order, with its contacts and sleep.
  /// If this throws before it calls `sort`, nothing has changed.
  void adopt(const Model<T, D>& model, BlockLayout<D> next, int threads,
             const std::function<void()>& sort);

  void find_elastic_limits(const Model<T, D>& model);

  /// Returns the velocity field of an event's snow. A new event gets a field of its own. If all
  /// fields are in use, the two oldest are joined before. `blocks` are those of the particles.
  int field_of_event(int event, std::vector<BlockKey>& blocks);
  /// Finds the fields of the events from the layout.
  void find_event_fields();

  const Material& material_of(const Model<T, D>& model, std::size_t particle) const {
    return model.materials[particles.has_material_id ? particles.material_id[particle] : 0];
  }
  /// Current over initial volume of a particle.
  double volume_ratio(const Model<T, D>& model, std::size_t particle) const;
  /// Contact radius of a particle, m.
  double contact_radius(const Model<T, D>& model, std::size_t particle) const;
  /// An upper bound of all contact radii, m.
  double largest_contact_radius(const Model<T, D>& model) const;
  Momentum momentum() const;
  /// Ends the balance of momentum so far, because the snow is going to be changed or a sample is
  /// taken. Sleep causes the remaining change, which belongs to the obstacles below
  /// sleeping snow.
  void end_balance(const Model<T, D>& model);
  /// Begins a balance with the present snow.
  void begin_balance() noexcept;
  /// Collects all impulses up to now in the record of forces. In the blocks of `idle`, snow slept
  /// since the last collection.
  void collect_forces(const Model<T, D>& model, const std::vector<std::int32_t>& idle) noexcept;
  void collect_forces(const Model<T, D>& model) noexcept { collect_forces(model, sleep.idle()); }
  /// Collects the impulses of contacts in blocks that are not among `next`.
  void collect_vanishing_forces(const Model<T, D>& model,
                                const std::vector<BlockKey>& next) noexcept;
  /// Moves the contacts with the obstacles in motion.
  void follow_obstacles(const Model<T, D>& model, int threads);
  /// Finds the forces of the snow that sleeps from now on. `reached` tells of an idle grid block
  /// whether snow reaches its nodes.
  void hold_sleeping_forces(const Model<T, D>& model,
                            const std::function<bool(std::int32_t)>& reached) noexcept;
  /// Records the forces of a step of dt that ended at `time`, after the impulses of awake snow.
  void end_force_step(double time, double dt) noexcept;
  /// Ends half a window of pressures if it is over.
  void end_pressure_half(const Model<T, D>& model) noexcept;
  double kinetic_energy(const Model<T, D>& model) const;
  double gravitational_energy(const Model<T, D>& model) const;
  double elastic_energy(const Model<T, D>& model) const;
  /// The energy balance up to now.
  EnergyBalance energy(const Model<T, D>& model) const;
  /// Records the present energies, and their excess over `before` (J) as added energy.
  void record_added(const Model<T, D>& model, double before);
};

}  // namespace snowshed::methods::mpm
