#include "snowshed/methods/quantities.hpp"

#include <stdexcept>

#include "snowshed/methods/registry.hpp"

namespace snowshed::methods {
namespace {

const std::vector<Quantity>& shared_quantities() {
  static const std::vector<Quantity> all{
      {"position", "m", "Position", 3},
      {"velocity", "m/s", "Velocity", 3},
      {"speed", "m/s", "Speed", 1, 0.05},
      {"mass", "kg", "Mass; in 2D per metre of width"},
      {"density", "kg/m3", "Current density", 1, 1.0},
      {"pressure", "Pa", "Kirchhoff pressure, positive in compression", 1, 100.0},
      {"id", "1", "Number that a particle keeps as long as it exists"},
      {"event", "1", "Event in which the particle was released, from 1"},
      {"material_id", "1", "Index of the particle's snow among the snows of the scene, from 0"},
  };
  return all;
}

/// Calls visit(quantity) for each quantity.
template <class Visit>
void for_each_quantity(const Visit& visit) {
  for (const Quantity& q : shared_quantities()) visit(q);
  for (const MethodDescriptor* method : all_methods())
    for (const Quantity& q : method->info().quantities) visit(q);
}

}  // namespace

std::vector<Quantity> quantities() {
  std::vector<Quantity> all;
  for_each_quantity([&](const Quantity& q) { all.push_back(q); });
  return all;
}

const Quantity& quantity(const std::string& name) {
  const Quantity* match = nullptr;
  for_each_quantity([&](const Quantity& q) {
    if (q.name == name) match = &q;
  });
  if (!match) throw std::out_of_range("no quantity " + name);
  return *match;
}

}  // namespace snowshed::methods
