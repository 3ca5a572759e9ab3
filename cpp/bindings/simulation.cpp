#include "snowshed/run/simulation.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "array_copies.hpp"
#include "bindings.hpp"
#include "method_bindings.hpp"
#include "scene_argument.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/quantities.hpp"
#include "snowshed/run/energy_history.hpp"
#include "snowshed/run/force_history.hpp"
#include "snowshed/run/run_record.hpp"
#include "user_laws.hpp"

namespace py = pybind11;

namespace snowshed {

py::object reseeding_dict(const std::optional<run::Reseeding>& r) {
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

py::dict report_dict(const run::RunReport& r) {
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

/// Runs the present event until it ends or the callback returns false; returns how it ended.
std::string run(run::Simulation& sim, const py::function& callback, double interval) {
  const auto observer = [&](const run::RunReport& r) {
    py::gil_scoped_acquire gil;
    return callback(report_dict(r)).cast<bool>();
  };
  py::gil_scoped_release release;
  const run::RunEnd end = sim.run(observer, interval);
  return end == run::RunEnd::paused ? "interrupted" : name_of(end);
}

py::dict energy(const run::Simulation& sim) {
  py::dict d;
  if (const auto* keeping = methods::capability<methods::KeepsEnergy>(sim.method()))
    for (const auto& [name, joules] : keeping->energies()) d[name.c_str()] = joules;
  return d;
}

py::dict energy_history(const run::Simulation& sim) {
  const run::EnergyHistory& history = sim.energy_history();
  return columns_of(history.columns(), history.values());
}

const run::ForceHistory& force_history(const run::Simulation& sim) {
  if (!sim.force_history())
    throw InputError("/output/forces", "false; forces are recorded only if it is true");
  return *sim.force_history();
}

/// A table of numbers by column; "obstacle" has names.
py::dict named_table(const run::NumberTable& table, const std::vector<std::string>& names) {
  py::dict d = columns_of(table.columns, table.values);
  py::list obstacles;
  for (const auto at : d["obstacle"].cast<std::vector<double>>())
    obstacles.append(names[std::size_t(at)]);
  d["obstacle"] = obstacles;
  return d;
}

/// The impulses and the forces on obstacles up to now, a row each.
py::dict obstacle_forces(const run::Simulation& sim) {
  const auto* keeping = methods::capability<methods::KeepsForces>(sim.method());
  if (!keeping || !keeping->forces())
    throw InputError("/output/forces", "false; forces are recorded only if it is true");
  const methods::ObstacleForces& record = *keeping->forces();
  std::vector<Vec3> impulse, force, moment, center;
  std::vector<double> normal, tangential;
  for (const methods::ObstacleForce& of : record.forces()) {
    impulse.push_back(of.impulse.total());
    force.push_back(of.recent.total());
    moment.push_back(of.recent.moment);
    center.push_back(of.recent.center());
    normal.push_back(of.recent.push);
    tangential.push_back(of.recent.tangential.norm());
  }
  py::dict d;
  d["obstacle"] = record.names();
  d["impulse"] = rows(impulse);
  d["force"] = rows(force);
  d["moment"] = rows(moment);
  d["center"] = rows(center);
  d["normal"] = column<double>(normal);
  d["tangential"] = column<double>(tangential);
  return d;
}

py::dict face_pressures(const run::Simulation& sim) {
  force_history(sim);
  const run::Simulation::Pressures p = sim.pressures();
  std::vector<Vec3> corners;
  for (const auto& x : p.corners) corners.emplace_back(x[0], x[1], x[2]);
  py::dict d;
  d["corners"] = rows(corners);
  d["corners_per_patch"] = p.per_patch;
  d["obstacle"] = column<std::int64_t>(p.obstacle);
  d["area"] = column<double>(p.area);
  d["rest"] = column<double>(p.rest);
  d["peak"] = column<double>(p.peak);
  d["peak_time"] = column<double>(p.peak_time);
  return d;
}

py::object frame(const run::Simulation& sim) { return panel_frame_dict(sim.scene()); }

std::vector<std::string> snows(const run::Simulation& sim) {
  std::vector<std::string> json;
  for (const material::Snow& snow : sim.snows()) json.push_back(scene::write_snow(snow));
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

template <double (run::Simulation::*distance)(const Vec3&) const>
py::array_t<double> distances_at(const run::Simulation& sim, const py::array_t<double>& points) {
  std::vector<double> distances;
  for (const Vec3& x : vectors(points, "points")) distances.push_back((sim.*distance)(x));
  return column<double>(distances);
}

/// The names, units and meanings of the quantities that files and fields hold.
py::list quantity_list() {
  py::list all;
  for (const methods::Quantity& q : methods::quantities())
    all.append(py::make_tuple(q.name, q.unit, q.meaning));
  return all;
}

py::dtype dtype_of(particles::FieldType type) {
  return with_field_type(type, [](auto zero) { return py::dtype::of<decltype(zero)>(); });
}

py::list field_list(const run::Simulation& sim) {
  py::list all;
  for (const particles::FieldInfo& f : sim.method().fields())
    all.append(py::make_tuple(f.name, f.unit, f.meaning, dtype_of(f.type), f.stored));
  return all;
}

py::array order_by_id(const run::Simulation& sim) {
  const std::vector<std::uint32_t>& order = sim.method().order_by_id();
  return column<std::int64_t>(order);
}

/// Returns for each particle, ordered by id, whether it is on the panel.
py::array on_panel(const run::Simulation& sim) {
  const particles::FieldView view = sim.method().field("position");
  std::vector<Vec3> positions;
  for (const std::uint32_t index : sim.method().order_by_id())
    positions.push_back(Vec3::Map(view.at<double>(index)));
  return column<bool>(sim.on_panel(positions));
}

void add_snow(run::Simulation& sim, const py::array_t<double>& positions, double mass,
              const std::array<double, 3>& velocity, int material_id) {
  methods::ParticleBatch batch;
  batch.positions = vectors(positions, "positions");
  batch.mass = mass;
  batch.velocity = Vec3(velocity[0], velocity[1], velocity[2]);
  batch.material_id = material_id;
  sim.add_snow(std::move(batch));
}

void bind_run(SimulationClass& c) {
  using namespace py::literals;
  c.changes("begin_event", [](run::Simulation& s) {
    std::optional<run::Reseeding> reseeding;
    {
      py::gil_scoped_release release;  // laws of the user may be Python functions
      reseeding = s.begin_event();
    }
    return reseeding_dict(reseeding);
  });
  c.changes(
      "run",
      [](run::Simulation& s, const py::function& callback, double interval) {
        return run(s, callback, interval);
      },
      "callback"_a, "interval_s"_a = 0.5);
  c.changes(
      "step",
      [](run::Simulation& s, int count) {
        py::gil_scoped_release release;
        s.step(count);
      },
      "count"_a = 1);
  c.changes("at_rest", [](run::Simulation& s) { return s.at_rest(); });
  c.changes("add_snow", &add_snow, "positions"_a, "mass"_a, "velocity"_a, "material_id"_a);
  c.changes(
      "add_velocity",
      [](run::Simulation& s, const py::array_t<double>& changes) {
        s.add_velocity(vectors(changes, "velocity changes"));
      },
      "velocity_changes"_a);
  c.changes(
      "settle",
      [](run::Simulation& s, const std::vector<double>& drops,
         const std::vector<double>& plastic_changes) { s.settle(drops, plastic_changes); },
      "drops"_a, "plastic_changes"_a);
}

void bind_files(SimulationClass& c) {
  using namespace py::literals;
  (*c).def_static(
      "load",
      [](const std::filesystem::path& path, const py::object& laws) {
        return std::make_unique<SimulationHandle>(run::Simulation::load(path, {}, laws_of(laws)));
      },
      "path"_a, "laws"_a = py::none());
  (*c).def_static(
      "load_into",
      [](const py::object& scene, const std::filesystem::path& base_dir,
         const std::filesystem::path& path) {
        return std::make_unique<SimulationHandle>(
            run::Simulation::load_into(scene_of(scene), base_dir, path));
      },
      "scene"_a, "base_dir"_a, "path"_a);
  c.reads(
      "save", [](const run::Simulation& s, const std::filesystem::path& path) { s.save(path); },
      "path"_a);
  c.changes(
      "set_snapshots",
      [](run::Simulation& s, const std::filesystem::path& dir, double interval) {
        s.write_snapshots(dir, interval);
      },
      "dir"_a, "interval_s"_a);
  c.reads(
      "write_vtk",
      [](const run::Simulation& s, const std::filesystem::path& path) { s.write_vtp(path); },
      "path"_a);
}

void bind_fields(SimulationClass& c) {
  using namespace py::literals;
  c.reads("fields", &field_list);
  c.reads(
      "field",
      [](const run::Simulation& s, const std::string& name) {
        return array_of(s.method().field(name));
      },
      "name"_a);
  c.reads(
      "field_by_id",
      [](const run::Simulation& s, const std::string& name) {
        return array_by_id(s.method(), name);
      },
      "name"_a);
  c.reads("order_by_id", &order_by_id);
  c.column("positions", "position");
  c.column("velocities", "velocity");
  c.column("masses", "mass");
  c.column("densities", "density");
  c.column("pressures", "pressure");
  c.column("plastic_strains", "volumetric_plastic_strain");
  c.column("events", "event");
  c.column("material_ids", "material_id");
  c.reads("on_panel", &on_panel);
  c.reads(
      "on_panel_at",
      [](const run::Simulation& s, const py::array_t<double>& positions, double laid_height) {
        return column<bool>(s.on_panel(vectors(positions, "positions"), laid_height));
      },
      "positions"_a, "laid_height"_a);
}

void bind_facts(SimulationClass& c) {
  using namespace py::literals;
  c.reads("energy", &energy);
  c.reads("energy_history", &energy_history);
  c.reads("force_history", [](const run::Simulation& s) {
    return named_table(force_history(s).forces(), force_history(s).names());
  });
  c.reads("loads", [](const run::Simulation& s) {
    return named_table(force_history(s).loads(), force_history(s).names());
  });
  c.reads("obstacle_forces", &obstacle_forces);
  c.reads("face_pressures", &face_pressures);
  c.reads("panel_frame", &frame);
  c.reads("obstacle_distance", &distances_at<&run::Simulation::obstacle_distance>, "points"_a);
  c.reads("resolved_distance", &distances_at<&run::Simulation::resolved_distance>, "points"_a);
  c.reads("input_note", [](const run::Simulation& s) { return s.input_note(); });
  c.property("notes", [](const run::Simulation& s) { return s.notes(); });
  c.property("expected_particles", [](const run::Simulation& s) {
    const std::vector<double>& particles = s.cost().particles;
    return particles.empty() ? 0.0 : particles.front();
  });
  c.property("event", [](const run::Simulation& s) { return s.event(); });
  c.property("event_count", [](const run::Simulation& s) { return s.scene().events.count; });
  c.property("event_running", [](const run::Simulation& s) { return s.event_running(); });
  c.property("time_s", [](const run::Simulation& s) { return s.event_time(); });
  c.property("damping_rate_per_s", [](const run::Simulation& s) { return s.damping_rate(); });
  c.property("total_steps", [](const run::Simulation& s) { return s.method().counters().steps; });
  c.property("rejected_steps",
             [](const run::Simulation& s) { return s.method().counters().rejected; });
  c.property("particle_updates",
             [](const run::Simulation& s) { return s.method().counters().particle_updates; });
  c.property("particle_count", [](const run::Simulation& s) { return s.method().size(); });
  c.property("time_step_s", [](const run::Simulation& s) { return s.method().time_step(); });
  c.property("scene", [](const run::Simulation& s) { return write_scene(s.scene()); });
  c.property("snows", &snows);
  c.property("threads", [](const run::Simulation& s) { return s.threads(); });
  c.property("resolution", [](const run::Simulation& s) { return s.resolution(); });
  c.property("dimension", [](const run::Simulation& s) { return s.scene().dimension; });
  c.property("ground_tilt_deg", [](const run::Simulation& s) {
    return s.scene().ground ? s.scene().ground->tilt : 0.0;
  });
}

}  // namespace

void bind_simulation(py::module_& m) {
  using namespace py::literals;
  m.def("quantities", &quantity_list, "(name, unit, meaning) of the quantities of particles.");
  SimulationClass c(m);
  (*c).def(py::init([](const py::object& scene, const std::filesystem::path& base_dir,
                       const py::object& laws) {
             return std::make_unique<SimulationHandle>(
                 std::make_shared<run::Simulation>(scene_of(scene), base_dir, laws_of(laws)));
           }),
           "scene"_a, "base_dir"_a = ".", "laws"_a = py::none());
  bind_run(c);
  bind_files(c);
  bind_fields(c);
  bind_facts(c);
  for (const MethodBindings& method : method_bindings()) method.simulation(c);
}

}  // namespace snowshed
