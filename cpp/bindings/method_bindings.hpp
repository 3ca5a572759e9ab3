// Bindings of the methods. Each method adds its own from a file in methods/ that no other file
// names.
#pragma once

#include <vector>

#include "simulation_class.hpp"

namespace snowshed {

struct MethodBindings {
  void (*module)(pybind11::module_&);    // adds functions
  void (*simulation)(SimulationClass&);  // adds methods to the class
};

/// The bindings of all methods.
inline std::vector<MethodBindings>& method_bindings() {
  static std::vector<MethodBindings> all;
  return all;
}

/// A constant of this type in a file adds that file's bindings.
struct AddedBindings {
  explicit AddedBindings(const MethodBindings& own) { method_bindings().push_back(own); }
};

}  // namespace snowshed
