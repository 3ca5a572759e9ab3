// Parts that all particle methods share.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/particles/id_order.hpp"

namespace snowshed::methods {

/// Whether the last step left particles that are not sound; the method can then only be read.
class Soundness {
 public:
  /// Throws SimulationError unless the particles are sound.
  void require() const {
    if (broken_)
      throw SimulationError("the simulation has failed; load an earlier checkpoint. It failed at " +
                            fault_);
  }
  [[noreturn]] void fail(std::string fault) {
    broken_ = true;
    fault_ = std::move(fault);
    throw SimulationError(fault_);
  }
  /// Marks the particles as unsound; `fail` gives the reason later.
  void lose() {
    broken_ = true;
    fault_.clear();
  }

 private:
  bool broken_ = false;
  std::string fault_;
};

/// The storage index of each particle, ordered by id. It is computed at the first request and kept
/// until `forget`.
class IdOrder {
 public:
  template <class Ids>
  const std::vector<std::uint32_t>& of(const Ids& ids) const {
    if (!known_) {
      order_ = particles::order_by_id(ids.data(), ids.size());
      known_ = true;
    }
    return order_;
  }
  void forget() { known_ = false; }

 private:
  mutable std::vector<std::uint32_t> order_;
  mutable bool known_ = false;
};

/// Throws InputError unless there is one value for each particle.
inline void check_count(const char* what, std::size_t given, std::size_t particles) {
  if (given != particles)
    throw InputError(
        what, std::to_string(given) + " given for " + std::to_string(particles) + " particles");
}

/// Throws InputError unless there is one finite change for each particle.
inline void check_velocity_changes(const std::vector<Vec3>& changes, std::size_t particles) {
  check_count("velocity changes", changes.size(), particles);
  for (const Vec3& change : changes)
    if (!change.allFinite()) throw InputError("velocity changes", "not finite");
}

/// Motion of all particles together: `mass(i)` and `square(i)` are a particle's mass and squared
/// speed.
template <class Mass, class Square>
MotionSummary motion_of(std::size_t particles, double speed, Mass mass, Square square) {
  MotionSummary m;
  double twice_kinetic = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    const double v2 = square(i), own = mass(i);
    m.mass += own;
    twice_kinetic += own * v2;
    if (v2 > speed * speed) m.moving_mass += own;
  }
  m.rms_speed = m.mass > 0 ? std::sqrt(twice_kinetic / m.mass) : 0;
  return m;
}

/// The memory of arrays, bytes.
template <class... Arrays>
std::size_t bytes_of(const Arrays&... arrays) {
  return (std::size_t(0) + ... + (arrays.capacity() * sizeof(arrays[0])));
}

}  // namespace snowshed::methods
