// The quantities that particles may have: their units and meanings.
#pragma once

#include <string>
#include <vector>

namespace snowshed::methods {

struct Quantity {
  std::string name, unit, meaning;
  int components = 1;
  double film_step = 0;  // resolution of small values in films; 0: not in films
};

/// The quantities that all methods share, then those of each method in turn.
std::vector<Quantity> quantities();

/// The quantity of this name; throws std::out_of_range if there is none.
const Quantity& quantity(const std::string& name);

}  // namespace snowshed::methods
