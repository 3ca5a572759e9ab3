// The record of the forces between the snow and its obstacles during a run.
//
// A method gives it the impulses of each step. Obstacles with the same name count as one. The
// record also keeps the balance of momentum: whatever neither gravity nor an obstacle explains is
// shown as unbalanced, so that a wrong force cannot hide.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "snowshed/methods/contact_impulse.hpp"
#include "snowshed/methods/pressure_map.hpp"
#include "snowshed/methods/running_means.hpp"

namespace snowshed::methods {

/// Forces on one obstacle, or on all obstacles of one name.
struct ObstacleForce {
  ContactImpulse impulse;  // since the method was made
  ContactImpulse recent;   // N, mean force over the last moments
  double age = 0;          // s, time over which it is a mean
  RunningMeans means;
};

/// Pressed area (m2; m per metre of width in 2D) and largest pressure of a patch (Pa).
struct Pressed {
  double area = 0, pressure = 0;

  void add(const Patch& patch, double patch_pressure) {
    if (!(patch_pressure > 0)) return;
    area += patch.area;
    pressure = std::max(pressure, patch_pressure);
  }
};

/// The impulse on an obstacle since the method was made, and its pressures since the last sample.
struct ForceSample {
  ContactImpulse impulse;  // N s
  Pressed pressed;
};

/// The forces on all obstacles while the snow rests, and the pressure of each patch, Pa.
struct RestingForces {
  struct OnObstacle {
    ContactImpulse force;  // N
    Pressed pressed;
  };
  std::vector<OnObstacle> forces;
  std::vector<double> pressures;
};

/// Mass and momentum of all snow.
struct Momentum {
  double mass = 0;               // kg
  Vec3 momentum = Vec3::Zero();  // kg m/s
};

class ObstacleForces {
 public:
  /// `resolution` is the smallest length that the method resolves, m.
  ObstacleForces(const std::vector<Obstacle>& obstacles, int dimension, double resolution);

  /// The names in tables: those of the obstacles, each once. An obstacle without a name is
  /// "obstacle 1", ... by its place in the list.
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<ObstacleForce>& forces() const { return forces_; }
  /// The place in `names` of an obstacle.
  std::size_t name_of(int obstacle) const { return name_of_[std::size_t(obstacle)]; }
  const PressureMap& pressures() const { return pressures_; }
  PressureMap& pressures() { return pressures_; }

  /// The impulse (N s) that the snow received and that neither gravity nor obstacles explain.
  const Vec3& unbalanced() const { return unbalanced_; }

  /// Adds the impulse of the present step on an obstacle to its running means.
  void add_step(std::size_t name, const Vec3& impulse) noexcept { step_[name] += impulse; }
  /// Ends a step of dt seconds.
  void end_step(double time, double dt) noexcept;

  /// Adds an impulse on an obstacle in the present interval, of one step or of several.
  void add(std::size_t name, const ContactImpulse& impulse, double factor = 1) noexcept {
    interval_[name].add(impulse, factor);
  }
  /// Ends an interval of `duration` seconds. `gravity` is the impulse that the snow received by
  /// gravity in it, N s.
  void end_interval(double duration, const Vec3& gravity) noexcept;

  void begin_event(double time) noexcept;

  /// Begins a balance of momentum, after the snow was changed from outside.
  void begin_balance(const Momentum& now) noexcept;
  /// Ends the balance so far and returns what it leaves, N s on the snow. The caller gives it to
  /// obstacles (`give`), or to `leave_unbalanced`.
  Vec3 end_balance(const Momentum& now) noexcept;
  void leave_unbalanced(const Vec3& impulse) noexcept { unbalanced_ += impulse; }
  void give(std::size_t name, const ContactImpulse& impulse) noexcept {
    forces_[name].impulse += impulse;
  }
  double mass() const { return mass_; }  ///< kg, of the balance

  /// A sample of each name after the last one, `duration` seconds ago.
  std::vector<ForceSample> sample(double duration);

  void save(io::BinaryWriter&) const;
  /// Throws InputError.
  void load(const io::BinaryReader&);

 private:
  template <class Archive, class Self>
  static void visit(Archive&, Self&);

  std::vector<std::string> names_;
  std::vector<std::size_t> name_of_;
  std::vector<ObstacleForce> forces_;
  std::vector<Vec3> step_;                // N s, in the present step
  std::vector<ContactImpulse> interval_;  // in the present interval
  PressureMap pressures_;
  double mass_ = 0;                 // kg, of all snow
  Vec3 momentum_ = Vec3::Zero();    // kg m/s, at the beginning of the balance
  Vec3 received_ = Vec3::Zero();    // N s, by gravity and obstacles since then
  Vec3 unbalanced_ = Vec3::Zero();  // N s
};

/// A method that can record the forces on its obstacles.
class KeepsForces {
 public:
  /// The record, or null if the method was made without one.
  virtual const ObstacleForces* forces() const = 0;
  /// Begins the record of an event: peaks are those of this event.
  virtual void begin_force_event() = 0;
  /// The impulses up to now, and the pressed areas since the last sample `duration` seconds ago.
  virtual std::vector<ForceSample> sample_forces(double duration) = 0;
  /// The forces now, as means over the vibrations of the snow. `at_rest`: no snow moves, so that
  /// the forces carry its whole weight.
  virtual RestingForces resting_forces(bool at_rest) const = 0;

 protected:
  ~KeepsForces() = default;
};

}  // namespace snowshed::methods
