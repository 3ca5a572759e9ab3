// The material point method: one explicit step at a time.
#pragma once

#include <memory>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/obstacle.hpp"

namespace snowshed {

struct MpmOptions {
  int dimension = 3;
  double gravity = 9.81;            // m/s2, along -z
  std::vector<Snow> snows{Snow()};  // by material_id; at least one, at most `max_materials`
  MpmSettings numerics;
  bool energy = false;  // keep the energy balance
};

inline constexpr int steps_between_sorts = 64;

std::unique_ptr<Method> make_mpm(const MpmOptions&, std::vector<Obstacle>);

}  // namespace snowshed
