// Particles to add to a method.
#pragma once

#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::methods {

/// Particles of one velocity and one kind of snow, of equal masses or each with its own.
struct ParticleBatch {
  std::vector<Vec3> positions;   // m
  Vec3 velocity = Vec3::Zero();  // m/s
  double fall_speed = 0;  // m/s down the slope of the ground, in place of `velocity`; on terrain
  double mass = 0;        // kg each (per metre of width in 2D)
  std::vector<double> masses;  // kg each, in place of `mass`; empty if all are equal
  int event = 1;
  int material_id = 0;

  double mass_of(std::size_t i) const { return masses.empty() ? mass : masses[i]; }
  double total_mass() const {
    if (masses.empty()) return mass * double(positions.size());
    double sum = 0;
    for (const double m : masses) sum += m;
    return sum;
  }
};

/// Throws InputError for a batch that no method can take: masses that are not positive, or not one
/// for each particle; a velocity that is not finite; a snow that is not in `materials`.
inline void check_batch(const ParticleBatch& batch, std::size_t materials) {
  if (batch.material_id < 0 || std::size_t(batch.material_id) >= materials)
    throw InputError("material_id", std::to_string(batch.material_id) + " is none of the " +
                                        std::to_string(materials) + " snows");
  if (!batch.masses.empty() && batch.masses.size() != batch.positions.size())
    throw InputError("masses", std::to_string(batch.masses.size()) + " given for " +
                                   std::to_string(batch.positions.size()) + " particles");
  const auto sound = [](double mass) { return mass > 0 && std::isfinite(mass); };
  bool all_sound = !batch.masses.empty() || sound(batch.mass);
  for (const double mass : batch.masses) all_sound = all_sound && sound(mass);
  if (!all_sound) throw InputError("mass", "of a particle must be positive");
  if (!batch.velocity.allFinite()) throw InputError("velocity", "not finite");
}

}  // namespace snowshed::methods
