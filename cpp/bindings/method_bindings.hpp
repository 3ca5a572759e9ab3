// Additions of methods to the module: each is in a file of its own in methods/, which no other file
// names.
#pragma once

#include <vector>

#include "simulation_class.hpp"

namespace snowshed {

struct MethodBindings {
  void (*module)(pybind11::module_&);    // adds functions
  void (*simulation)(SimulationClass&);  // adds methods to the class
};

/// Those of all methods.
inline std::vector<MethodBindings>& method_bindings() {
  static std::vector<MethodBindings> all;
  return all;
}

/// A constant of this type in a file adds that file's bindings.
struct AddedBindings {
  explicit AddedBindings(const MethodBindings& own) { method_bindings().push_back(own); }
};

}  // namespace snowshed
