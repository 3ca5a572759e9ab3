// The results folder of a run: what is in it, and how it is made and opened again.
#pragma once

#include <filesystem>

#include "snowshed/run/simulation.hpp"

namespace snowshed {

/// Holds scene.json, run.json (`RunRecord`), checkpoint.bin, particles/event_NNN.vtp,
/// particles.pvd and snapshots/.
class ResultsFolder {
 public:
  /// Makes the folder for a scene. Throws InputError where it holds anything.
  static ResultsFolder create(std::filesystem::path folder, const Scene& scene);

  /// Opens the folder of an earlier run of the same scene. Throws InputError where it is not one.
  static ResultsFolder reopen(std::filesystem::path folder, const Scene& scene);

  /// Throws InputError unless `folder` is new or empty.
  static void require_empty(const std::filesystem::path& folder);

  std::filesystem::path checkpoint() const { return folder_ / "checkpoint.bin"; }
  std::filesystem::path record() const { return folder_ / "run.json"; }
  std::filesystem::path snapshots() const { return folder_ / "snapshots"; }

  /// Writes the particles after an event, and adds them to the series of all events.
  void write_particles(const Simulation&) const;

 private:
  explicit ResultsFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
};

}  // namespace snowshed
