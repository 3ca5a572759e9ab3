// How snow behaves at the surface of an obstacle.
#pragma once

namespace snowshed {

/// Collision conditions, of the velocity relative to the obstacle. `sticky` and `slip` are the
/// thesis's (1.2.3), `separate` is its SEPARATE but for a short memory (see NodeKernels::apply).
///
/// sticky    all of it is zero
/// slip      its normal part is zero both ways: snow stays in the surface; Coulomb friction
/// separate  no normal part inward, snow may leave; Coulomb friction
enum class Condition { sticky, slip, separate };

struct ContactLaw {
  Condition condition;
  double friction;  // Coulomb coefficient
};

}  // namespace snowshed
