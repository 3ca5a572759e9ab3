// One function per bound part of the library.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

namespace snowshed::scene {
struct Scene;
}

namespace snowshed::run {
struct Reseeding;
struct RunReport;
}  // namespace snowshed::run

namespace snowshed {

void register_errors(pybind11::module_&);
void bind_scene(pybind11::module_&);
void bind_simulation(pybind11::module_&);
void bind_event_sequence(pybind11::module_&);
void bind_film(pybind11::module_&);
void bind_geometry(pybind11::module_&);
void bind_machine(pybind11::module_&);
void bind_material(pybind11::module_&);
void bind_program(pybind11::module_&);

pybind11::object reseeding_dict(const std::optional<run::Reseeding>&);  ///< None if there is none
pybind11::dict report_dict(const run::RunReport&);
pybind11::object panel_frame_dict(const scene::Scene&);  ///< None if there is no panel

}  // namespace snowshed
