// Conditions on the velocity of snow at the surface of an obstacle.
#pragma once

namespace snowshed::methods {

/// Conditions on the velocity relative to the obstacle at a collision. `sticky` and `slip` are
/// those of the thesis (section 1.2.3). `separate` differs from its SEPARATE in two ways: it has a
/// short memory (see mpm/contact_rule.hpp), and it removes the inward part of the velocity.
///
/// sticky    the whole relative velocity is zero
/// slip      the normal part is zero: snow neither enters nor leaves; Coulomb friction
/// separate  the normal part does not point inward: snow may leave; Coulomb friction
enum class Condition { sticky, slip, separate };

}  // namespace snowshed::methods
