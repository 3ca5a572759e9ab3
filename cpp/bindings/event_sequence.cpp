#include "snowshed/run/event_sequence.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "bindings.hpp"
#include "scene_argument.hpp"
#include "simulation_handle.hpp"
#include "snowshed/run/external_record.hpp"
#include "user_laws.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

py::dict record_dict(const run::EventRecord& record) {
  py::dict d;
  d["event"] = record.event;
  d["sim_time_s"] = record.sim_time;
  d["steps"] = record.steps;
  d["wall_s"] = record.wall;
  d["ended"] = name_of(record.ended);
  d["laid_height_m"] = record.laid_height;
  d["damping_rate_per_s"] = record.damping_rate.value_or(std::numeric_limits<double>::quiet_NaN());
  py::dict energy;
  for (const auto& [name, joules] : record.energy) energy[name.c_str()] = joules;
  d["energy"] = energy;
  d["energy_residual"] = record.energy_residual();
  return d;
}

using Path = std::filesystem::path;

/// Runs Python's signal handlers, whose exceptions, such as KeyboardInterrupt, pass through.
bool python_interrupts() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return false;
}

/// Passes all calls to a Python object with the same methods.
class PythonObserver : public run::EventObserver {
 public:
  explicit PythonObserver(py::object observer) : observer_(std::move(observer)) {}

  void between_events(run::Simulation&) override {
    py::gil_scoped_acquire gil;
    observer_.attr("between_events")();
  }
  void event_begun(const run::Simulation&,
                   const std::optional<run::Reseeding>& reseeding) override {
    py::gil_scoped_acquire gil;
    observer_.attr("event_begun")(reseeding_dict(reseeding));
  }
  void noted(const std::string& note) override {
    py::gil_scoped_acquire gil;
    observer_.attr("noted")(note);
  }
  void progress(const run::Simulation&, const run::RunReport& report) override {
    py::gil_scoped_acquire gil;
    observer_.attr("progress")(report_dict(report));
  }
  void event_ended(const run::Simulation&, const run::EventRecord& record) override {
    py::gil_scoped_acquire gil;
    observer_.attr("event_ended")(record_dict(record));
  }
  void before_checkpoint(const run::Simulation&) override {
    py::gil_scoped_acquire gil;
    observer_.attr("before_checkpoint")();
  }
  bool stop_requested() override {
    py::gil_scoped_acquire gil;
    return observer_.attr("stop_requested")().cast<bool>();
  }

 private:
  py::object observer_;
};

bool run_sequence(run::EventSequence& sequence, const py::object& observer,
                  double report_interval) {
  PythonObserver passing_on(observer);
  py::gil_scoped_release release;
  return sequence.run(passing_on, report_interval);
}

py::list finished_events(const run::EventSequence& sequence) {
  py::list events;
  for (const run::EventRecord& record : sequence.record().finished_events)
    events.append(record_dict(record));
  return events;
}

}  // namespace

void bind_event_sequence(py::module_& m) {
  using namespace py::literals;
  py::class_<run::EventSequence, std::shared_ptr<run::EventSequence>>(m, "EventSequence")
      .def_static(
          "create",
          [](const py::object& scene, const Path& base_dir, const Path& folder,
             const py::object& laws) {
            return run::EventSequence::create(scene_of(scene), base_dir, folder, python_interrupts,
                                              laws_of(laws));
          },
          "scene"_a, "base_dir"_a, "folder"_a, "laws"_a = py::none())
      .def_static(
          "resume",
          [](const py::object& scene, const Path& base_dir, const Path& folder,
             const py::object& laws) {
            return run::EventSequence::resume(scene_of(scene), base_dir, folder, laws_of(laws));
          },
          "scene"_a, "base_dir"_a, "folder"_a, "laws"_a = py::none())
      .def("run", &run_sequence, "observer"_a, "report_interval_s"_a)
      .def("__enter__", [](run::EventSequence& self) -> run::EventSequence& { return self; })
      .def("__exit__", [](run::EventSequence& self, const py::args&) { self.close(); })
      .def("record_failure", &run::EventSequence::record_failure, "error"_a)
      .def(
          "add_note",
          [](run::EventSequence& s, const std::string& note) {
            run::ExternalRecord(s).add_note(note);
          },
          "note"_a)
      .def_property_readonly("notes", [](const run::EventSequence& s) { return s.record().notes; })
      .def(
          "set_finished_work",
          [](run::EventSequence& s, std::int64_t steps, double wall) {
            run::ExternalRecord(s).set_finished_work(steps, wall);
          },
          "steps"_a, "wall_s"_a)
      .def(
          "describe_machine",
          [](run::EventSequence& s, std::map<std::string, std::string> facts) {
            run::ExternalRecord(s).describe_machine(std::move(facts));
          },
          "facts"_a)
      .def(
          "set_ageing",
          [](run::EventSequence& s, const std::string& settings) {
            run::ExternalRecord(s).set_ageing(settings);
          },
          "settings"_a)
      .def_property(
          "tables", [](const run::EventSequence& s) { return s.record().tables; },
          [](run::EventSequence& s, run::RunRecord::Tables tables) {
            run::ExternalRecord(s).set_tables(std::move(tables));
          })
      .def_property(
          "files",
          [](const run::EventSequence& s) {
            std::map<std::string, std::pair<std::uint64_t, std::string>> files;
            for (const auto& [name, mark] : s.record().files)
              files[name] = {mark.bytes, mark.checksum};
            return files;
          },
          [](run::EventSequence& s,
             const std::map<std::string, std::pair<std::uint64_t, std::string>>& given) {
            run::RunRecord::Files files;
            for (const auto& [name, mark] : given) files[name] = {mark.first, mark.second};
            run::ExternalRecord(s).set_files(std::move(files));
          })
      .def("rewrite_record", [](run::EventSequence& s) { run::ExternalRecord(s).rewrite(); })
      .def_property_readonly(
          "simulation",
          [](const std::shared_ptr<run::EventSequence>& s) {  // kept alive by the simulation
            return std::make_unique<SimulationHandle>(
                std::shared_ptr<run::Simulation>(s, &s->simulation()));
          })
      .def_property_readonly("finished_events", &finished_events);
}

}  // namespace snowshed
