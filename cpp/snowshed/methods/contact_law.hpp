// Behaviour of snow at the surface of an obstacle.
#pragma once

#include "snowshed/methods/condition.hpp"
#include "snowshed/methods/user_laws.hpp"

namespace snowshed::methods {

struct ContactLaw {
  Condition condition;
  double friction;                    // Coulomb coefficient
  FrictionLaw coefficient = nullptr;  // the user's, in place of `friction`
};

}  // namespace snowshed::methods
