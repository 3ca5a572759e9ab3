// How snow behaves at the surface of an obstacle.
#pragma once

namespace snowshed {

/// Collision conditions of the thesis (1.2.3).
enum class Condition { sticky, slip, separate };

struct ContactLaw {
  Condition condition;
  double friction;  // Coulomb coefficient
};

}  // namespace snowshed
