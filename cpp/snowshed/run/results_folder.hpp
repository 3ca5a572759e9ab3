// The results folder of a run: its contents, and how it is made and opened again.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "snowshed/io/folder_lock.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed::run {

/// Holds scene.json, run.json (`RunRecord`), checkpoint.bin, particles/event_NNN.vtp,
/// particles.pvd, film.bin, snapshots/, and with forces forces.csv, loads.csv and
/// pressures/event_NNN.vtp. It is locked: no other run writes into it meanwhile.
/// Opening it removes files that a killed run left half-written.
class ResultsFolder {
 public:
  /// Makes the folder for a scene. Throws InputError if it holds anything.
  static ResultsFolder create(std::filesystem::path folder, const scene::Scene& scene);

  /// Opens the folder of an earlier run of the same scene. Throws InputError if it is not one.
  static ResultsFolder reopen(std::filesystem::path folder, const scene::Scene& scene);

  /// Throws InputError unless `folder` is new or empty; remains of a killed run do not count.
  static void require_empty(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path checkpoint() const { return folder_ / "checkpoint.bin"; }
  std::filesystem::path record() const { return folder_ / "run.json"; }
  std::filesystem::path film() const { return folder_ / "film.bin"; }
  std::filesystem::path snapshots() const { return folder_ / "snapshots"; }

  /// Reads the checkpoint. Throws InputError if it is damaged, or of another scene.
  std::unique_ptr<Simulation> load_checkpoint(const scene::Scene&,
                                              const methods::UserLaws& laws) const;

  /// The checksum of its scene.json.
  std::string scene_checksum() const;

  /// Releases the folder to another run.
  void unlock() { lock_.release(); }

  /// Writes the particles after an event, and adds them to the series of all events.
  void write_particles(const Simulation&) const;

  /// Writes the forces on obstacles so far, if they are recorded. Returns the names of the files.
  std::vector<std::string> write_forces(const Simulation&) const;
  /// Writes the pressures on faces after an event, if they are recorded.
  void write_pressures(const Simulation&) const;

 private:
  explicit ResultsFolder(std::filesystem::path folder);

  std::filesystem::path folder_;
  io::FolderLock lock_;
};

}  // namespace snowshed::run
