#include "snowshed/run/results_folder.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/io/pvd_series.hpp"
#include "snowshed/io/vtp_writer.hpp"
#include "snowshed/run/force_history.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace fs = std::filesystem;

namespace snowshed::run {
namespace {

/// The JSON paths at which two scenes differ, "/panel/tilt, /snow/density", except for settings
/// that a run may be resumed with.
std::string differences(const scene::Scene& one, const scene::Scene& other) {
  const auto json_of = [](const scene::Scene& s) {
    auto json = scene::parse_json(scene::write_scene(scene::resolve(s)), "scene");
    for (const char* setting : scene::settings_of_machines) json["numerics"].erase(setting);
    return json;
  };
  std::set<std::string> paths;
  for (const auto& change : nlohmann::json::diff(json_of(one), json_of(other)))
    paths.insert(change["path"].get<std::string>());
  std::string list;
  for (const std::string& path : paths) list += (list.empty() ? "" : ", ") + path;
  return list;
}

/// Turns errors of the file system into FileErrors.
template <class Action>
auto with_file_errors(Action action) {
  try {
    return action();
  } catch (const fs::filesystem_error& error) {
    throw FileError(error.path1().string(), error.code().message(), error.code().value());
  }
}

std::string event_file(const char* folder, const Simulation& sim) {
  char name[32];
  std::snprintf(name, sizeof name, "%s/event_%03d.vtp", folder, sim.event());
  return name;
}

void make_folder(const fs::path& folder) {
  with_file_errors([&] { fs::create_directories(folder); });
}

}  // namespace

void ResultsFolder::require_empty(const fs::path& folder) {
  const bool exists = with_file_errors([&] { return fs::exists(folder); });
  if (!exists) return;
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "is not a folder");
  const bool empty = with_file_errors([&] {
    const auto entries = fs::directory_iterator(folder);
    return std::all_of(begin(entries), end(entries), io::is_leftover);
  });
  if (!empty)
    throw InputError(folder.string(), "not empty; choose a new folder, or resume the run in it");
}

ResultsFolder ResultsFolder::create(fs::path folder, const scene::Scene& scene) {
  require_empty(folder);
  make_folder(folder);
  ResultsFolder made(std::move(folder));
  require_empty(made.folder_);  // another run may have begun meanwhile
  io::write_atomic(made.folder_ / "scene.json", write_scene(scene));
  return made;
}

ResultsFolder ResultsFolder::reopen(fs::path folder, const scene::Scene& scene) {
  const fs::path file = folder / "scene.json";
  if (!with_file_errors([&] { return fs::is_regular_file(file); }))
    throw InputError(folder.string(), "nothing to resume; it holds no scene.json");
  const std::string paths = differences(scene::load_scene(file), scene);
  if (!paths.empty())
    throw InputError(folder.string(), "made by another scene, which differs in " + paths +
                                          "; resume with the scene.json in it");
  return ResultsFolder(std::move(folder));
}

ResultsFolder::ResultsFolder(fs::path folder) : folder_(std::move(folder)), lock_(folder_) {
  io::remove_leftovers(folder_);
  std::error_code failed;
  for (fs::directory_iterator at(folder_, failed), end; !failed && at != end; at.increment(failed))
    if (at->symlink_status(failed).type() == fs::file_type::directory)
      io::remove_leftovers(at->path());
}

std::unique_ptr<Simulation> ResultsFolder::load_checkpoint(const scene::Scene& scene,
                                                           const methods::UserLaws& laws) const {
  auto sim = Simulation::load(checkpoint(), &scene, laws);
  const std::string paths = differences(sim->scene(), scene);
  if (!paths.empty())
    throw InputError(checkpoint().string(),
                     "made by another scene, which differs from scene.json in " + paths);
  return sim;
}

std::string ResultsFolder::scene_checksum() const {
  return snowshed::scene::scene_checksum(io::read_bytes(folder_ / "scene.json"));
}

std::vector<std::string> ResultsFolder::write_forces(const Simulation& sim) const {
  const ForceHistory* history = sim.force_history();
  if (!history) return {};
  io::write_atomic(folder_ / "forces.csv", history->forces_csv());
  io::write_atomic(folder_ / "loads.csv", history->loads_csv());
  return {"forces.csv", "loads.csv"};
}

void ResultsFolder::write_pressures(const Simulation& sim) const {
  const Simulation::Pressures p = sim.pressures();
  if (p.area.empty()) return;
  make_folder(folder_ / "pressures");
  io::write_faces_vtp(folder_ / event_file("pressures", sim), p.corners, p.per_patch,
                      {{"obstacle", 1, p.obstacle},
                       {"area", 1, p.area},
                       {"rest_pressure", 1, p.rest},
                       {"peak_pressure", 1, p.peak},
                       {"peak_time", 1, p.peak_time}});
}

void ResultsFolder::write_particles(const Simulation& sim) const {
  const std::string name = event_file("particles", sim);
  make_folder(folder_ / "particles");
  sim.write_vtp(folder_ / name);
  io::PvdSeries::reopen(folder_ / "particles.pvd", sim.event()).append(sim.event(), name);
}

}  // namespace snowshed::run
