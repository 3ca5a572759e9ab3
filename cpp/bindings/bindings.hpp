// One function per bound part of the library.
#pragma once

#include <pybind11/pybind11.h>

namespace snowshed {

void bind_scene(pybind11::module_&);
void bind_simulation(pybind11::module_&);
void bind_material(pybind11::module_&);

}  // namespace snowshed
