// snowshed._core: the C++ library as Python sees it. No logic here.
#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "method_bindings.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled core of snowshed.";
  m.attr("version") = SNOWSHED_VERSION;
  snowshed::register_errors(m);
  snowshed::bind_scene(m);
  snowshed::bind_simulation(m);
  snowshed::bind_event_sequence(m);
  snowshed::bind_film(m);
  snowshed::bind_material(m);
  for (const snowshed::MethodBindings& method : snowshed::method_bindings()) method.module(m);
}
