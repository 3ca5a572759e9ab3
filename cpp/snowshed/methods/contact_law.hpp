// Behaviour of snow at the surface of an obstacle.
#pragma once

namespace snowshed {

/// Conditions on the velocity relative to the obstacle at a collision. `sticky` and `slip` are
/// those of the thesis (1.2.3); `separate` is its SEPARATE with a short memory (see
/// NodeKernels::apply).
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
