// Behaviour of snow at the surface of an obstacle.
#pragma once

namespace snowshed::methods {

/// Conditions on the velocity relative to the obstacle at a collision. `sticky` and `slip` are
/// those of the thesis (1.2.3); `separate` is its SEPARATE with a short memory (see
/// NodeKernels::apply).
///
/// sticky    the whole relative velocity is zero
/// slip      the normal part is zero: snow neither enters nor leaves; Coulomb friction
/// separate  the normal part does not point inward: snow may leave; Coulomb friction
enum class Condition { sticky, slip, separate };

struct ContactLaw {
  Condition condition;
  double friction;  // Coulomb coefficient
};

}  // namespace snowshed::methods
