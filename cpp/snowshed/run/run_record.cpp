#include "snowshed/run/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "snowshed/core/build_id.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/core/version.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/checksum.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/json_value.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json to_json(const EventRecord& record) {
  ordered_json j{{"event", record.event},          {"sim_time_s", record.sim_time},
                 {"steps", record.steps},          {"wall_s", record.wall},
                 {"ended", name_of(record.ended)}, {"laid_height_m", record.laid_height}};
  j["damping_rate_per_s"] = or_null(record.damping_rate);
  for (const auto& [name, joules] : record.energy) j["energy"][name] = joules;
  if (const auto share = record.energy_residual()) j["energy_residual"] = *share;
  return j;
}

/// The value of a required key.
const json& require(const json& object, const char* key, const std::string& path) {
  if (!object.is_object()) throw scene::wrong_type(path, object, "an object");
  if (!object.contains(key)) throw InputError(path, std::string("has no ") + key);
  return object[key];
}

/// Reads the end of an event.
RunEnd run_end(const std::string& name, const std::string& path) {
  for (const RunEnd end : {RunEnd::rest, RunEnd::time_limit})
    if (name == name_of(end)) return end;
  throw InputError(path, quote(name) + "; allowed: \"rest\", \"time_limit\"");
}

EventRecord event_record(const json& j, const std::vector<std::string>& energies,
                         const std::string& path) {
  const auto number = [&](const char* key) {
    return scene::to_number(require(j, key, path), path + "/" + key, "a number");
  };
  EventRecord record;
  record.event = int(std::clamp(number("event"), 0.0, 1e9));
  record.sim_time = number("sim_time_s");
  record.steps = std::int64_t(std::clamp(number("steps"), 0.0, 1e18));
  record.wall = number("wall_s");
  record.ended =
      run_end(scene::to_text(require(j, "ended", path), path + "/ended"), path + "/ended");
  record.laid_height = number("laid_height_m");
  const char* const damping = "damping_rate_per_s";
  if (j.contains(damping) && !j[damping].is_null()) record.damping_rate = number(damping);
  if (!j.contains("energy")) return record;
  for (const std::string& name : energies)
    record.energy.emplace_back(
        name, scene::to_number(require(j["energy"], name.c_str(), path + "/energy"),
                               path + "/energy/" + name, "a number"));
  return record;
}

/// Converts a method's section about a run.
ordered_json to_json(const methods::ReportsRun::Section& section) {
  ordered_json j = ordered_json::object();
  for (const auto& [name, value] : section.facts)
    std::visit([&, name = name](const auto& number) { j[name] = number; }, value);
  return j;
}

RunRecord::Tables table_checksums(const json& j) {
  RunRecord::Tables tables;
  if (!j.is_object()) throw scene::wrong_type("/tables", j, "an object");
  for (const auto& [table, sums] : j.items()) {
    if (!sums.is_object()) throw scene::wrong_type(pointer("/tables", table), sums, "an object");
    for (const auto& [event, sum] : sums.items())
      tables[table][event] = scene::to_text(sum, pointer(pointer("/tables", table), event));
  }
  return tables;
}

RunRecord::Files file_marks(const json& j, const std::string& where) {
  if (!j.is_object()) throw scene::wrong_type(where, j, "an object");
  RunRecord::Files marks;
  for (const auto& [name, mark] : j.items()) {
    const std::string path = pointer(where, name);
    const double bytes =
        scene::to_number(require(mark, "bytes", path), path + "/bytes", "a number");
    marks[name] = {std::uint64_t(std::clamp(bytes, 0.0, 1e15)),
                   scene::to_text(require(mark, "checksum", path), path + "/checksum")};
  }
  return marks;
}

ordered_json to_json(const RunRecord::Files& files) {
  ordered_json j = ordered_json::object();
  for (const auto& [name, mark] : files)
    j[name] = {{"bytes", mark.bytes}, {"checksum", mark.checksum}};
  return j;
}

/// Reads a file in blocks, because the files of a scene may be large.
FileMark mark_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  io::Crc32 sum;
  FileMark mark;
  char block[1 << 16];
  while (stream) {
    stream.read(block, sizeof block);
    sum.update(block, std::size_t(stream.gcount()));
    mark.bytes += std::uint64_t(stream.gcount());
  }
  if (!stream.eof()) throw InputError(file.string(), "cannot be read");
  mark.checksum = io::hexadecimal(sum.value());
  return mark;
}

/// The time now in UTC, "2026-11-27T20:35:14Z".
std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::vector<std::string> note_list(const json& j) {
  std::vector<std::string> notes;
  if (!j.is_array()) throw scene::wrong_type("/notes", j, "an array");
  for (std::size_t i = 0; i < j.size(); ++i)
    notes.push_back(scene::to_text(j[i], "/notes/" + std::to_string(i)));
  return notes;
}

}  // namespace

std::optional<double> EventRecord::energy_residual() const {
  if (energy.empty()) return std::nullopt;
  const auto residual = energy.end() - 1;
  double largest = 0;
  for (auto sink = energy.begin(); sink != residual; ++sink)
    largest = std::max(largest, std::abs(sink->second));
  return largest > 0 ? std::abs(residual->second) / largest : 0.0;
}

std::string name_of(RunEnd end) {
  if (end == RunEnd::paused) throw std::logic_error("an event that is paused has not ended");
  return end == RunEnd::rest ? "rest" : "time_limit";
}

std::string name_of(RunStatus status) {
  switch (status) {
    case RunStatus::running:
      return "running";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::failed:
      return "failed";
    case RunStatus::finished:
      return "finished";
  }
  return "";
}

RunRecord RunRecord::read(const std::filesystem::path& file,
                          const std::vector<std::string>& energies) try {
  RunRecord record;
  if (!std::filesystem::is_regular_file(file)) return record;
  const std::string text = io::read_bytes(file);
  scene::check_seal(text, "text");
  const json j = scene::parse_json(text, "text");
  if (j.contains("files") && !j.contains("checksum"))
    throw InputError("text", "its checksum is missing");
  record.wall = scene::to_number(require(j, "wall_s", "/"), "/wall_s", "a number");
  if (j.contains("tables")) record.tables = table_checksums(j["tables"]);
  if (j.contains("files")) record.files = file_marks(j["files"], "/files");
  if (j.contains("inputs")) record.inputs = file_marks(j["inputs"], "/inputs");
  if (j.contains("ageing")) record.ageing = j["ageing"].dump();
  if (j.contains("build")) record.build = scene::to_text(j["build"], "/build");
  if (j.contains("notes")) record.notes = note_list(j["notes"]);
  if (!j.contains("finished_events")) return record;  // written by an earlier version
  const json& events = j["finished_events"];
  if (!events.is_array()) throw scene::wrong_type("/finished_events", events, "an array");
  for (std::size_t i = 0; i < events.size(); ++i)
    record.finished_events.push_back(
        event_record(events[i], energies, "/finished_events/" + std::to_string(i)));
  return record;
} catch (const InputError& error) {
  throw InputError(file.string(), std::string("damaged: ") + error.what());
}

void RunRecord::write(const std::filesystem::path& file, const Simulation& sim, RunStatus status,
                      const std::string& error) const {
  const methods::Method& method = sim.method();
  const methods::StepCounters& c = method.counters();
  ordered_json j{{"version", SNOWSHED_VERSION}, {"build", build_id()},
                 {"commit", build_commit()},    {"compiler", compiler_name()},
                 {"date", utc_now()},           {"kernels", kernel_variant_name()}};
  for (const auto& [key, fact] : machine) j[key] = fact;
  j["device"] = sim.device().name();
  j["threads"] = sim.threads();
  j["scalar"] = sim.scene().numerics->scalar();
  j["dimension"] = sim.scene().dimension;
  j["events"] = sim.event() - int(sim.event_running());
  j["particles"] = method.size();
  j["steps"] = c.steps;
  j["rejected_steps"] = c.rejected;
  j["damping_rate_per_s"] = or_null(sim.damping_rate());
  j["particle_updates"] = c.particle_updates;
  j["slept_updates"] = methods::slept_updates(method);
  j["updates_per_s"] = wall > 0 ? double(c.particle_updates) / wall : 0.0;
  j["peak_memory_mb"] = double(peak_resident_bytes()) / 1e6;
  j["wall_s"] = wall;
  if (const auto* reporting = methods::capability<methods::ReportsRun>(method)) {
    const methods::ReportsRun::Section section = reporting->run_section();
    j[section.name] = to_json(section);
  }
  j["notes"] = notes;
  j["finished_events"] = ordered_json::array();
  for (const EventRecord& record : finished_events) j["finished_events"].push_back(to_json(record));
  if (!tables.empty()) j["tables"] = tables;
  j["files"] = to_json(files);
  j["inputs"] = to_json(inputs);
  if (!scene.empty()) j["scene_checksum"] = scene;
  if (const auto film = sim.film_mark())
    j["film"] = {{"frames", film->frames}, {"checksum", io::hexadecimal(film->checksum)}};
  j["status"] = name_of(status);
  if (!error.empty()) j["error"] = error;
  if (sim.laws().any()) j["laws"] = sim.laws().name;
  if (!sim.laws().digest.empty()) j["laws_digest"] = sim.laws().digest;
  if (!ageing.empty()) j["ageing"] = ordered_json::parse(ageing);
  j["scene"] = ordered_json::parse(scene::write_scene(sim.scene()));
  io::write_atomic(file, scene::sealed_text(j));
}

void RunRecord::mark_inputs(const scene::Scene& scene, const std::filesystem::path& base_dir) {
  for (const std::string& file : scene::input_files(scene))
    if (!inputs.count(file)) inputs[file] = mark_of(base_dir / file);
}

void RunRecord::mark_file(const std::filesystem::path& folder, const std::string& name) {
  files[name] = mark_of(folder / name);
}

void RunRecord::check_files(const std::filesystem::path& folder) const {
  for (const auto& [name, mark] : files) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file)) continue;
    const std::string bytes = io::read_bytes(file);
    io::Crc32 sum;
    sum.update(bytes.data(), std::min<std::size_t>(bytes.size(), mark.bytes));
    if (bytes.size() < mark.bytes || io::hexadecimal(sum.value()) != mark.checksum)
      throw InputError(file.string(), "damaged: not as the run wrote it; restore it, or remove it");
  }
}

bool RunRecord::add_note(const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) != notes.end()) return false;
  notes.push_back(note);
  return true;
}

void RunRecord::keep_through(int event) {
  const auto later = [event](const EventRecord& record) { return record.event > event; };
  finished_events.erase(std::remove_if(finished_events.begin(), finished_events.end(), later),
                        finished_events.end());
}

}  // namespace snowshed::run
