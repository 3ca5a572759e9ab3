// The quantities that particles may have: their units and meanings.
#pragma once

#include <string>
#include <vector>

namespace snowshed {

struct Quantity {
  std::string name, unit, meaning;
  int components = 1;
  double film_step = 0;  // in which a film stores small values; 0: films do not hold it
};

/// Those that all methods share, then those of each method in turn.
std::vector<Quantity> quantities();

/// The quantity of this name; throws std::out_of_range if the method has none.
const Quantity& quantity(const std::string& name);

}  // namespace snowshed
