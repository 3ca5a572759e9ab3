// The return mapping alone, so that Python can compare it with an independent integration.
#include <pybind11/numpy.h>

#include "bindings.hpp"
#include "snowshed/material/cam_clay.hpp"
#include "snowshed/scene/scene.hpp"

namespace py = pybind11;

namespace snowshed {

void bind_material(py::module_& m) {
  using namespace py::literals;
  using Law = material::CamClay<double>;
  py::class_<Law>(m, "CamClay", "Cohesive Modified Cam-Clay snow in the p-q plane, in double.")
      .def(py::init(&Law::from), "youngs_modulus"_a, "poissons_ratio"_a, "critical_state_slope"_a,
           "cohesion"_a, "hardening_factor"_a, "dimension"_a = 3)
      .def("initial_plastic_strain", py::vectorize(&Law::initial_plastic_strain), "p0"_a)
      .def("preconsolidation",
           py::vectorize([](const Law* law, double ev) { return law->preconsolidation(ev); }),
           "ev"_a)
      .def(
          "yield_function",
          [](const Law& law, double p, double q, double p0) {
            return law.yield(material::PQ<double>{p, q}, p0);
          },
          "p"_a, "q"_a, "p0"_a)
      .def(
          "return_map",
          [](const Law& law, double p, double q, double ev) {
            material::PQ<double> s{p, q};
            law.return_map(s, ev);
            return py::make_tuple(s.p, s.q, ev);
          },
          "p"_a, "q"_a, "ev"_a, "(p, q, e_v) after bringing the trial back to the yield surface.")
      .def_property_readonly("bulk", [](const Law& law) { return law.elastic.bulk; })
      .def_property_readonly("shear", [](const Law& law) { return law.elastic.mu; });
}

}  // namespace snowshed
