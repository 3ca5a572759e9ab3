// One function per bound part of the library.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

namespace snowshed {

struct Reseeding;
struct RunReport;

void register_errors(pybind11::module_&);
void bind_scene(pybind11::module_&);
void bind_simulation(pybind11::module_&);
void bind_event_sequence(pybind11::module_&);
void bind_film(pybind11::module_&);
void bind_geometry(pybind11::module_&);
void bind_machine(pybind11::module_&);
void bind_material(pybind11::module_&);

pybind11::object reseeding_dict(const std::optional<Reseeding>&);  ///< None if there is none
pybind11::dict report_dict(const RunReport&);

}  // namespace snowshed
