// The quantities that particles of any method may have: the one place of their units and meanings.
#pragma once

#include <string>
#include <vector>

namespace snowshed {

struct Quantity {
  std::string name, unit, meaning;
  int components = 1;
};

const std::vector<Quantity>& quantities();

/// The quantity of this name; throws std::out_of_range where there is none.
const Quantity& quantity(const std::string& name);

}  // namespace snowshed
