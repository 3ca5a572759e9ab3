#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <nlohmann/json.hpp>

#include "bindings.hpp"
#include "scene_argument.hpp"
#include "snowshed/run/cost_report.hpp"
#include "snowshed/scene/earlier_version.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/panel_frame.hpp"
#include "snowshed/scene/presets.hpp"
#include "snowshed/scene/unusual_values.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

py::dict plan_dict(const py::object& argument, const std::filesystem::path& base_dir) {
  const scene::Scene scene = scene_of(argument);
  const run::CostReport report = run::report_cost(scene, base_dir);
  const int events = scene.events.count;
  py::dict d;
  d["used"] = report.used;
  d["left_out"] = report.left_out;
  d["particles_per_event"] =
      std::int64_t(report.cost.particles.empty() ? 0.0 : report.cost.particles.front());
  d["particles_total"] = std::int64_t(report.cost.total_particles);
  py::dict parts;
  for (const auto& [name, count] : report.cost.parts) parts[name.c_str()] = std::int64_t(count);
  d["parts"] = parts;
  d["memory_bytes"] = std::int64_t(report.cost.bytes);
  d["card_memory_bytes"] = std::int64_t(report.cost.card_bytes);
  d["device"] = report.device;
  d["time_step_s"] = report.cost.time_step;
  d["steps_per_event"] = std::int64_t(report.cost.steps / events);
  d["expected_wall_s"] = report.wall_time;
  d["updates_per_s"] = report.updates_per_s;
  d["threads"] = report.threads;
  d["kernels"] = report.kernels;
  d["scalar"] = scene.numerics->scalar();
  return d;
}

/// Issues a Python warning for each note on changes since the version of a scene.
void warn(const std::vector<std::string>& notes, const std::string& file = "") {
  for (const std::string& note : notes) {
    const std::string message = file.empty() ? note : file + ": " + note;
    if (PyErr_WarnEx(PyExc_FutureWarning, message.c_str(), 1)) throw py::error_already_set();
  }
}

std::string updated(const std::string& text) {
  nlohmann::json scene = scene::parse_json(text, "scene");
  scene::update_version(scene);
  return scene.dump();
}

py::object vector(const Vec3& v) { return py::make_tuple(v[0], v[1], v[2]); }

}  // namespace

py::object panel_frame_dict(const scene::Scene& scene) {
  if (!scene.panel) return py::none();
  const scene::PanelFrame frame = panel_frame(scene);
  py::dict d;
  d["center"] = vector(frame.center);
  d["normal"] = vector(frame.normal);
  d["slope"] = vector(frame.slope);
  d["length"] = frame.length;
  d["width"] = frame.width;
  d["board_thickness"] = frame.board_thickness;
  return d;
}

void bind_scene(py::module_& m) {
  using namespace py::literals;
  py::class_<ParsedScene>(m, "ParsedScene", "A complete, validated scene.")
      .def_static(
          "parse",
          [](const std::string& text, const std::filesystem::path& base_dir) {
            std::vector<std::string> notes;
            const scene::Scene scene = scene::parse_scene(text, "scene", &notes);
            warn(notes);
            return ParsedScene(scene::resolve(scene::with_absolute_files(base_dir, scene)));
          },
          "text"_a, "base_dir"_a = ".",
          "The scene of a JSON text; relative file names in it refer to base_dir.")
      .def_static(
          "load",
          [](const std::filesystem::path& path) {
            std::vector<std::string> notes;
            const scene::Scene scene = scene::load_scene(path, &notes);
            warn(notes, path.string());
            return ParsedScene(scene::resolve(scene));
          },
          "path"_a, "The scene of a file; relative file names in it refer to the file's folder.")
      .def_property_readonly("json", [](const ParsedScene& s) { return s.json; })
      .def_property_readonly(
          "unusual_values",
          [](const ParsedScene& s) {
            std::vector<std::string> notes;
            scene::add_notes_on_unusual_values(s.scene, notes);
            return notes;
          },
          "Notes on values that are probably in another unit; no file is read for them.")
      .def(
          "panel_frame", [](const ParsedScene& s) { return panel_frame_dict(s.scene); },
          "The position of the panel's face and the thickness of its board; None without a panel.");
  m.def("update_version", &updated, "text"_a,
        "The JSON of a scene in the present version, with the same meaning.");
  m.def("scene_checksum", &scene::scene_checksum, "text"_a,
        "A checksum of the values in a scene's text, except the threads and the device.");
  m.def("scene_schema", &scene::scene_schema, "The JSON Schema of a scene.");
  m.def(
      "preset", [](const std::string& name) { return write_scene(scene::preset_scene(name)); },
      "name"_a);
  m.def(
      "snow_preset",
      [](const std::string& name) { return scene::write_snow(scene::preset_snow(name)); },
      "name"_a);
  m.def("plan", &plan_dict, "scene"_a, "base_dir"_a = ".");
  m.def(
      "expected_work",
      [](const py::object& scene, const std::filesystem::path& base_dir) {
        return run::expected_work(scene_of(scene), base_dir);
      },
      "scene"_a, "base_dir"_a = ".",
      "Expected work of a run, in particle updates of unbroken snow; nothing is measured.");
}

}  // namespace snowshed
