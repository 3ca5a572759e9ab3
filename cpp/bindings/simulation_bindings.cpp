#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/run/run_record.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

py::array_t<double> rows(const std::vector<Vec3>& vectors) {
  py::array_t<double> a({py::ssize_t(vectors.size()), py::ssize_t(3)});
  auto out = a.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < a.shape(0); ++i)
    for (int k = 0; k < 3; ++k) out(i, k) = vectors[std::size_t(i)][k];
  return a;
}

template <class To, class From>
py::array_t<To> column(const std::vector<From>& values) {
  py::array_t<To> a(py::ssize_t(values.size()));
  auto out = a.template mutable_unchecked<1>();
  for (py::ssize_t i = 0; i < a.shape(0); ++i) out(i) = To(values[std::size_t(i)]);
  return a;
}

py::object vector(const Vec3& v) { return py::make_tuple(v[0], v[1], v[2]); }

}  // namespace

py::object reseeding_dict(const std::optional<Reseeding>& r) {
  if (!r) return py::none();
  py::dict d;
  for (const auto& [when, cloud] : {std::pair("before", &r->before), {"after", &r->after}}) {
    const std::string suffix = std::string("_") + when;
    d[("positions" + suffix).c_str()] = rows(cloud->positions);
    d[("masses" + suffix).c_str()] = column<double>(cloud->masses);
    d[("densities" + suffix).c_str()] = column<double>(cloud->densities);
    d[("on_panel" + suffix).c_str()] = column<bool>(cloud->on_panel);
  }
  return d;
}

py::dict report_dict(const RunReport& r) {
  py::dict d;
  d["time_s"] = r.time;
  d["steps"] = r.steps;
  d["dt_s"] = r.time_step;
  d["rms_speed"] = r.rms_speed;
  d["particles"] = r.particles;
  d["updates_per_s"] = r.updates_per_s;
  d["progress"] = r.progress;
  return d;
}

namespace {

/// The callback answers whether to go on.
std::string run(Simulation& sim, const py::function& callback, double interval) {
  const auto observer = [&](const RunReport& r) {
    py::gil_scoped_acquire gil;
    return callback(report_dict(r)).cast<bool>();
  };
  py::gil_scoped_release release;
  const RunEnd end = sim.run(observer, interval);
  return end == RunEnd::paused ? "interrupted" : name_of(end);
}

py::dict energy(const Simulation& sim) {
  py::dict d;
  for (const auto& [name, joules] : named_energies(sim.solver().energy())) d[name.c_str()] = joules;
  return d;
}

py::object frame(const Simulation& sim) {
  if (!sim.scene().panel) return py::none();
  const PanelFrame f = panel_frame(sim.scene());
  py::dict d;
  d["center"] = vector(f.center);
  d["normal"] = vector(f.normal);
  d["slope"] = vector(f.slope);
  d["length"] = f.length;
  d["width"] = f.width;
  return d;
}

py::array_t<std::int64_t> material_ids(const Simulation& sim) {
  std::vector<std::uint8_t> material_ids = sim.solver().state().material_ids;
  material_ids.resize(sim.solver().size());  // of one snow: all zero
  return column<std::int64_t>(material_ids);
}

std::vector<std::string> snows(const Simulation& sim) {
  std::vector<std::string> json;
  for (const Snow& snow : sim.snows()) json.push_back(write_snow(snow));
  return json;
}

std::vector<Vec3> vectors(const py::array_t<double>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(name, "an array of shape (n, 3) is needed");
  const auto x = array.unchecked<2>();
  std::vector<Vec3> out;
  for (py::ssize_t i = 0; i < x.shape(0); ++i) out.emplace_back(x(i, 0), x(i, 1), x(i, 2));
  return out;
}

py::array_t<double> obstacle_distance(const Simulation& sim, const py::array_t<double>& points) {
  std::vector<double> distances;
  for (const Vec3& x : vectors(points, "points")) distances.push_back(sim.obstacle_distance(x));
  return column<double>(distances);
}

py::object affine(const Simulation& sim) {
  const std::vector<Mat3> matrices = sim.solver().state().affine;
  if (matrices.empty()) return py::none();
  py::array_t<double> a({py::ssize_t(matrices.size()), py::ssize_t(3), py::ssize_t(3)});
  auto out = a.mutable_unchecked<3>();
  for (py::ssize_t i = 0; i < a.shape(0); ++i)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) out(i, r, c) = matrices[std::size_t(i)](r, c);
  return a;
}

}  // namespace

void bind_simulation(py::module_& m) {
  using namespace py::literals;
  py::class_<Simulation>(m, "Simulation")
      .def(py::init([](const std::string& json, const std::string& base_dir) {
             return std::make_unique<Simulation>(parse_scene(json), base_dir);
           }),
           "scene_json"_a, "base_dir"_a = ".")
      .def_static(
          "load", [](const std::string& path) { return Simulation::load(path); }, "path"_a)
      .def(
          "save", [](const Simulation& s, const std::string& path) { s.save(path); }, "path"_a)
      .def("begin_event", [](Simulation& s) { return reseeding_dict(s.begin_event()); })
      .def("run", &run, "callback"_a, "interval_s"_a = 0.5)
      .def("step", &Simulation::step, "count"_a = 1, py::call_guard<py::gil_scoped_release>())
      .def(
          "kick",
          [](Simulation& s, const py::array_t<double>& changes) {
            s.add_velocity(vectors(changes, "velocity changes"));
          },
          "velocity_changes"_a)
      .def("settle", &Simulation::settle, "drops"_a, "plastic_changes"_a)
      .def(
          "set_snapshots",
          [](Simulation& s, const std::string& dir, double interval) {
            s.write_snapshots(dir, interval);
          },
          "dir"_a, "interval_s"_a)
      .def(
          "write_vtk", [](const Simulation& s, const std::string& path) { s.write_vtp(path); },
          "path"_a)
      .def("energy", &energy)
      .def("panel_frame", &frame)
      .def("positions", [](const Simulation& s) { return rows(s.solver().state().positions); })
      .def("velocities", [](const Simulation& s) { return rows(s.solver().state().velocities); })
      .def("affine", &affine)
      .def("pressures",
           [](const Simulation& s) { return column<double>(s.solver().state().pressures); })
      .def("plastic_strains",
           [](const Simulation& s) { return column<double>(s.solver().state().plastic_strains); })
      .def("masses", [](const Simulation& s) { return column<double>(s.solver().state().masses); })
      .def("events",
           [](const Simulation& s) { return column<std::int64_t>(s.solver().state().events); })
      .def("kinds", &material_ids)
      .def("density",
           [](const Simulation& s) { return column<double>(s.solver().state().densities); })
      .def("on_panel",
           [](const Simulation& s) {
             return column<bool>(s.on_panel(s.solver().state().positions));
           })
      .def(
          "on_panel_at",
          [](const Simulation& s, const py::array_t<double>& positions, double laid_height) {
            return column<bool>(s.on_panel(vectors(positions, "positions"), laid_height));
          },
          "positions"_a, "laid_height"_a)
      .def("obstacle_distance", &obstacle_distance, "points"_a)
      .def_property_readonly("event", &Simulation::event)
      .def_property_readonly("event_count",
                             [](const Simulation& s) { return s.scene().events.count; })
      .def_property_readonly("event_running", &Simulation::event_running)
      .def_property_readonly("time_s", &Simulation::event_time)
      .def_property_readonly("total_steps",
                             [](const Simulation& s) { return s.solver().counters().steps; })
      .def_property_readonly("rejected_steps",
                             [](const Simulation& s) { return s.solver().counters().rejected; })
      .def_property_readonly(
          "particle_updates",
          [](const Simulation& s) { return s.solver().counters().particle_updates; })
      .def_property_readonly(
          "slept_updates", [](const Simulation& s) { return s.solver().counters().slept_updates; })
      .def_property_readonly("sorts",
                             [](const Simulation& s) { return s.solver().counters().sorts; })
      .def_property_readonly("particle_count",
                             [](const Simulation& s) { return s.solver().size(); })
      .def_property_readonly("time_step_s",
                             [](const Simulation& s) { return s.solver().time_step(); })
      .def_property_readonly("scene", [](const Simulation& s) { return write_scene(s.scene()); })
      .def_property_readonly("snows", &snows)
      .def_property_readonly("threads", &Simulation::threads)
      .def_property_readonly("resolution", &Simulation::resolution)
      .def_property_readonly("dimension", [](const Simulation& s) { return s.scene().dimension; })
      .def_property_readonly("ground_tilt_deg", [](const Simulation& s) {
        return s.scene().ground ? s.scene().ground->tilt : 0.0;
      });
}

}  // namespace snowshed
