// snowshed._core: the C++ library in Python, without logic of its own.
#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "method_bindings.hpp"
#include "snowshed/core/build_id.hpp"
#include "snowshed/core/version.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled core of snowshed.";
  m.attr("version") = SNOWSHED_VERSION;
  m.attr("build_id") = snowshed::build_id();
  m.attr("build_commit") = snowshed::build_commit();
  m.attr("build_compiler") = snowshed::compiler_name();
  snowshed::register_errors(m);
  snowshed::bind_scene(m);
  snowshed::bind_simulation(m);
  snowshed::bind_event_sequence(m);
  snowshed::bind_program(m);
  snowshed::bind_film(m);
  snowshed::bind_geometry(m);
  snowshed::bind_machine(m);
  snowshed::bind_material(m);
  for (const snowshed::MethodBindings& method : snowshed::method_bindings()) method.module(m);
}
