// snowshed._core: the C++ library as Python sees it. No logic here.
#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "snowshed/core/errors.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled core of snowshed.";
  m.attr("version") = SNOWSHED_VERSION;
  py::register_exception<snowshed::InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<snowshed::SimulationError>(m, "SimulationError", PyExc_RuntimeError);
  py::register_exception<snowshed::FileError>(m, "FileError", PyExc_OSError);
  snowshed::bind_scene(m);
  snowshed::bind_simulation(m);
  snowshed::bind_event_sequence(m);
  snowshed::bind_film(m);
  snowshed::bind_material(m);
}
