// What only a simulation of grains tells.
#include <pybind11/numpy.h>

#include "array_copies.hpp"
#include "simulation_class.hpp"
#include "snowshed/methods/grains/solver.hpp"
#include "snowshed/run/loading_curve.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

/// The rows so far, column by column.
py::dict curve(const Simulation& sim) {
  const LoadingCurve& curve = sim.loading_curve();
  return columns_of(curve.columns(), curve.values());
}

/// Grains that touch: their numbers (n, 2), where, the force on the first, and whether bonded.
py::tuple contacts(const Simulation& sim) {
  const std::vector<GrainContact> contacts = sim.grains().grain_contacts();
  py::array_t<std::int64_t> grains({py::ssize_t(contacts.size()), py::ssize_t(2)});
  auto pairs = grains.mutable_unchecked<2>();
  std::vector<Vec3> points, forces;
  std::vector<bool> bonded;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    pairs(py::ssize_t(i), 0) = contacts[i].first;
    pairs(py::ssize_t(i), 1) = contacts[i].second;
    points.push_back(contacts[i].point);
    forces.push_back(contacts[i].force);
    bonded.push_back(contacts[i].bonded);
  }
  return py::make_tuple(grains, rows(points), rows(forces), column<bool>(bonded));
}

/// Centres of the spheres (n, 3), and the grain that each belongs to.
py::tuple spheres(const Simulation& sim) {
  return py::make_tuple(rows(sim.grains().sphere_positions()),
                        column<std::int64_t>(sim.grains().sphere_grains()));
}

}  // namespace

void bind_grains(SimulationClass& c) {
  c.reads("grains_curve", &curve);
  c.reads("grains_contacts", &contacts);
  c.reads("grains_spheres", &spheres);
}

}  // namespace snowshed
