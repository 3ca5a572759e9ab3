// Properties of a simulation by the material point method.
#include "method_bindings.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/fields_by_id.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace py = pybind11;

namespace snowshed::methods::mpm {
namespace {

/// The solver as one of MPM; throws InputError if the scene's method is another.
const Solver& mpm_of(const run::Simulation& sim) {
  const auto* mpm = dynamic_cast<const Solver*>(&sim.method());
  if (!mpm) throw InputError("/method", "only \"mpm\" has the counter \"sorts\"");
  return *mpm;
}

std::int64_t sorts(const run::Simulation& sim) { return mpm_of(sim).sorts(); }

/// The affine matrices (n, 3, 3), ordered by id; None with a transfer that has none.
py::object affine(const run::Simulation& sim) {
  const char* const name = "affine";
  if (!has_field(sim.method(), name)) return py::none();
  return array_by_id(sim.method(), name);
}

const AddedBindings added{{[](py::module_&) {},
                           [](SimulationClass& c) {
                             c.property("sorts", &sorts);
                             c.reads("affine", &affine);
                           }}};

}  // namespace
}  // namespace snowshed::methods::mpm
