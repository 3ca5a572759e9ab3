// Properties of a simulation of grains.
#include <pybind11/numpy.h>

#include <algorithm>

#include "array_copies.hpp"
#include "method_bindings.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace py = pybind11;

namespace snowshed::methods::grains {
namespace {

/// The solver as grains; throws InputError if the scene's method is another.
const Solver& grains_of(const run::Simulation& sim) {
  const auto* grains = dynamic_cast<const Solver*>(&sim.method());
  if (!grains) throw InputError("/method", "is not \"grains\", and loads no sample");
  return *grains;
}

/// The rows of the curve so far, as columns by name.
py::dict curve(const run::Simulation& sim) {
  grains_of(sim);  // throws for other methods
  return columns_of(sim.curve()->columns(), sim.curve()->values());
}

/// The contacts between grains: the numbers of both grains (n, 2), the position (m), the force on
/// the first grain (N), and whether the grains are bonded.
py::tuple contacts(const run::Simulation& sim) {
  const std::vector<GrainContact> contacts = grains_of(sim).grain_contacts();
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

/// Centres of the spheres (n, 3), m, and the number of the grain of each.
py::tuple spheres(const run::Simulation& sim) {
  return py::make_tuple(rows(grains_of(sim).sphere_positions()),
                        column<std::int64_t>(grains_of(sim).sphere_grains()));
}

using LabelArray = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// An image of labels (nz, ny, nx).
LabelImage image_of(const LabelArray& labels) {
  if (labels.ndim() != 3) throw InputError("labels", "(nz, ny, nx) is needed");
  LabelImage image;
  for (int axis = 0; axis < 3; ++axis)
    image.size[std::size_t(axis)] = std::size_t(labels.shape(2 - axis));
  image.labels.assign(labels.data(), labels.data() + labels.size());
  return image;
}

std::string checked_label_note(const LabelArray& labels, bool split) {
  const LabelPieces pieces = count_pieces(image_of(labels));
  check_labels(pieces);
  return label_note(pieces, split);
}

py::array_t<std::int32_t> split_labels(const LabelArray& labels) {
  LabelImage image = image_of(labels);
  split_pieces(image);
  py::array_t<std::int32_t> pieces({labels.shape(0), labels.shape(1), labels.shape(2)});
  std::copy(image.labels.begin(), image.labels.end(), pieces.mutable_data());
  return pieces;
}

void bind_labels(py::module_& m) {
  m.attr("min_grain_diameter") = min_grain_diameter;
  m.attr("max_grain_diameter") = max_grain_diameter;
  m.def("check_grain_diameter", &check_grain_diameter, py::arg("median"),
        "Throws InputError unless the median diameter of grains (m) is that of snow.");
  m.def("label_note", &checked_label_note, py::arg("labels"), py::arg("split"),
        "Warnings about labels (nz, ny, nx), or an empty text. Throws InputError if they are not "
        "labels.");
  m.def("split_labels", &split_labels, py::arg("labels"),
        "Labels in which each connected piece has a number of its own.");
}

const AddedBindings added{{&bind_labels, [](SimulationClass& c) {
                             c.reads("grains_curve", &curve);
                             c.reads("grains_contacts", &contacts);
                             c.reads("grains_spheres", &spheres);
                           }}};

}  // namespace
}  // namespace snowshed::methods::grains
