#include "snowshed/run/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "snowshed/core/compensated_sum.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/methods/grains/energy.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mps/solver.hpp"
#include "snowshed/methods/slide/energy.hpp"
#include "snowshed/methods/slide/solver.hpp"
#include "snowshed/scene/enum_names.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/json_value.hpp"
#include "snowshed/scene/message_format.hpp"

namespace snowshed {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json to_json(const EventFacts& facts) {
  ordered_json j{{"event", facts.event}, {"sim_time_s", facts.sim_time},
                 {"steps", facts.steps}, {"wall_s", facts.wall},
                 {"ended", facts.ended}, {"laid_height_m", facts.laid_height}};
  j["damping_rate_per_s"] = or_null(facts.damping_rate);
  for (const auto& [name, joules] : facts.energy) j["energy"][name] = joules;
  if (const auto share = facts.energy_residual()) j["energy_residual"] = *share;
  return j;
}

/// The value of a key that must be there.
const json& require(const json& object, const char* key, const std::string& path) {
  if (!object.is_object()) throw wrong_type(path, object, "an object");
  if (!object.contains(key)) throw InputError(path, std::string("has no ") + key);
  return object[key];
}

/// The energies of the method that has such, in the order of tables.
NamedEnergies energies_like(const json& given) {
  for (const NamedEnergies& own : {named_energies(SlideEnergy{}), named_energies(GrainsEnergy{})})
    if (given.is_object() && given.size() == own.size() &&
        std::all_of(own.begin(), own.end(),
                    [&](const auto& energy) { return given.contains(energy.first); }))
      return own;
  return named_energies(EnergyBalance{});
}

EventFacts event_facts(const json& j, const std::string& path) {
  const auto number = [&](const char* key) {
    return to_number(require(j, key, path), path + "/" + key, "a number");
  };
  EventFacts facts;
  facts.event = int(std::clamp(number("event"), 0.0, 1e9));
  facts.sim_time = number("sim_time_s");
  facts.steps = std::int64_t(std::clamp(number("steps"), 0.0, 1e18));
  facts.wall = number("wall_s");
  facts.ended = to_text(require(j, "ended", path), path + "/ended");
  facts.laid_height = number("laid_height_m");
  const char* const damping = "damping_rate_per_s";
  if (j.contains(damping) && !j[damping].is_null()) facts.damping_rate = number(damping);
  if (!j.contains("energy")) return facts;
  for (const auto& [name, _] : energies_like(j["energy"]))
    facts.energy.emplace_back(name, to_number(require(j["energy"], name.c_str(), path + "/energy"),
                                              path + "/energy/" + name, "a number"));
  return facts;
}

/// What was released and taken up, and where it is: the sums differ by rounding alone.
ordered_json balance_of(const SlideMethod& slide) {
  const MassBalance& m = slide.mass_balance();
  const FieldView masses = slide.field("mass");
  const double on_terrain = compensated_sum(masses.at<double>(0), slide.size());
  return {{"released_kg", m.released},
          {"entrained_kg", m.entrained},
          {"left_terrain_kg", m.left},
          {"on_terrain_kg", on_terrain},
          {"residual_kg", m.released + m.entrained - m.left - on_terrain}};
}

/// How well the equations were solved, in the last step and on average, and how dense the snow is.
ordered_json equations_of(const MpsMethod& mps) {
  const MpsReport r = mps.report();
  return {{"pressure_iterations", r.pressure_iterations},
          {"pressure_residual", r.pressure_residual},
          {"mean_pressure_iterations", r.mean_pressure_iterations},
          {"viscosity_iterations", r.viscosity_iterations},
          {"viscosity_residual", r.viscosity_residual},
          {"mean_viscosity_iterations", r.mean_viscosity_iterations},
          {"density_error", r.density_error},
          {"largest_density", r.largest_density}};
}

std::map<std::string, std::map<std::string, std::string>> table_checksums(const json& j) {
  std::map<std::string, std::map<std::string, std::string>> tables;
  if (!j.is_object()) throw wrong_type("/tables", j, "an object");
  for (const auto& [table, sums] : j.items()) {
    if (!sums.is_object()) throw wrong_type(pointer("/tables", table), sums, "an object");
    for (const auto& [event, sum] : sums.items())
      tables[table][event] = to_text(sum, pointer(pointer("/tables", table), event));
  }
  return tables;
}

std::vector<std::string> note_list(const json& j) {
  std::vector<std::string> notes;
  if (!j.is_array()) throw wrong_type("/notes", j, "an array");
  for (std::size_t i = 0; i < j.size(); ++i)
    notes.push_back(to_text(j[i], "/notes/" + std::to_string(i)));
  return notes;
}

}  // namespace

std::optional<double> EventFacts::energy_residual() const {
  double largest = 0, residual = 0;
  for (const auto& [name, joules] : energy) {
    if (name == "residual_j")
      residual = std::abs(joules);
    else
      largest = std::max(largest, std::abs(joules));
  }
  if (energy.empty()) return std::nullopt;
  return largest > 0 ? residual / largest : 0.0;
}

std::string name_of(RunEnd end) { return end == RunEnd::rest ? "rest" : "time_limit"; }

RunRecord RunRecord::read(const std::filesystem::path& file) try {
  RunRecord record;
  if (!std::filesystem::is_regular_file(file)) return record;
  const json j = parse_json(read_bytes(file), "text");
  record.wall = to_number(require(j, "wall_s", "/"), "/wall_s", "a number");
  if (j.contains("tables")) record.tables = table_checksums(j["tables"]);
  if (j.contains("notes")) record.notes = note_list(j["notes"]);
  if (!j.contains("finished_events")) return record;  // of the version before
  const json& events = j["finished_events"];
  if (!events.is_array()) throw wrong_type("/finished_events", events, "an array");
  for (std::size_t i = 0; i < events.size(); ++i)
    record.finished.push_back(event_facts(events[i], "/finished_events/" + std::to_string(i)));
  return record;
} catch (const InputError& error) {
  throw InputError(file.string(), std::string("damaged: ") + error.what());
}

void RunRecord::write(const std::filesystem::path& file, const Simulation& sim,
                      const std::string& status, const std::string& error) const {
  const Method& method = sim.solver();
  const StepCounters& c = method.counters();
  ordered_json j{{"version", SNOWSHED_VERSION}, {"kernels", kernel_variant()}};
  for (const auto& [key, fact] : machine) j[key] = fact;
  j["threads"] = sim.threads();
  const Scene& scene = sim.scene();
  j["scalar"] = name_of(scene.uses<MpmSettings>() ? scene.mpm().precision : Precision::float64);
  j["dimension"] = sim.scene().dimension;
  j["events"] = sim.event() - int(sim.event_running());
  j["particles"] = method.size();
  j["steps"] = c.steps;
  j["rejected_steps"] = c.rejected;
  j["damping_rate_per_s"] = or_null(sim.damping_rate());
  j["particle_updates"] = c.particle_updates;
  j["slept_updates"] = c.slept_updates;
  j["updates_per_s"] = wall > 0 ? double(c.particle_updates) / wall : 0.0;
  j["peak_memory_mb"] = double(peak_resident_bytes()) / 1e6;
  j["wall_s"] = wall;
  if (const auto* slide = dynamic_cast<const SlideMethod*>(&method))
    j["mass_balance"] = balance_of(*slide);
  if (const auto* mps = dynamic_cast<const MpsMethod*>(&method))
    j["equations"] = equations_of(*mps);
  j["notes"] = notes;
  j["finished_events"] = ordered_json::array();
  for (const EventFacts& facts : finished) j["finished_events"].push_back(to_json(facts));
  if (!tables.empty()) j["tables"] = tables;
  j["status"] = status;
  if (!error.empty()) j["error"] = error;
  write_atomic(file, pretty(j));
}

bool RunRecord::add_note(const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) != notes.end()) return false;
  notes.push_back(note);
  return true;
}

void RunRecord::keep_through(int event) {
  const auto later = [event](const EventFacts& facts) { return facts.event > event; };
  finished.erase(std::remove_if(finished.begin(), finished.end(), later), finished.end());
}

}  // namespace snowshed
