// The contents of run.json: machine and version of a run, its progress, and the course of each
// event.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "snowshed/run/simulation.hpp"

namespace snowshed::run {

/// Course of one event. With particles/event_NNN.vtp it suffices to measure the event.
struct EventRecord {
  int event = 0;
  double sim_time = 0;  // s
  std::int64_t steps = 0;
  double wall = 0;  // s
  RunEnd ended = RunEnd::rest;
  double laid_height = 0;              // m, see Simulation::laid_height
  std::optional<double> damping_rate;  // 1/s, its mean, see MethodDescriptor::damping_rate
  std::vector<std::pair<std::string, double>>
      energy;  // J, by name, the residual last; empty without the energy balance

  /// Energy that the time integration gained or lost, over the largest of the energies; none
  /// without the energy balance.
  std::optional<double> energy_residual() const;
};

/// Length of a file as a run wrote it, and the checksum (CRC-32) of that part: a growing file may
/// be longer by now.
struct FileMark {
  std::uint64_t bytes = 0;
  std::string checksum;
};

/// Residuals of the energy above this share give a warning.
inline constexpr double max_energy_residual = 0.01;

/// Returns the name of an ended event's `RunEnd` in run.json: "rest" or "time_limit". Throws
/// std::logic_error for `paused`, because such an event has not ended.
std::string name_of(RunEnd);

enum class RunStatus { running, interrupted, failed, finished };

/// Returns the name of a status in run.json.
std::string name_of(RunStatus);

class RunRecord {
 public:
  /// Checksums by table name and event number: of all rows up to that event.
  using Tables = std::map<std::string, std::map<std::string, std::string>>;
  using Files = std::map<std::string, FileMark>;  ///< by name

  /// Reads run.json; returns an empty record if the file is missing. Throws InputError if it is
  /// damaged. `energies` are the names of an event's energies, in order, if it has any.
  static RunRecord read(const std::filesystem::path& file,
                        const std::vector<std::string>& energies);

  /// Writes run.json. An `error` belongs to the status `failed`.
  void write(const std::filesystem::path& file, const Simulation&, RunStatus,
             const std::string& error = "") const;

  /// Records length and checksum of each file that the scene names, unless they are known.
  void mark_inputs(const scene::Scene& scene, const std::filesystem::path& base_dir);

  /// Records length and checksum of a file in the folder.
  void mark_file(const std::filesystem::path& folder, const std::string& name);

  /// Throws InputError if one of `files` exists, but is not as the run wrote it.
  void check_files(const std::filesystem::path& folder) const;

  /// Forgets the events after `event`, which will be run again.
  void keep_through(int event);

  /// Adds a note for readers of the results, a sentence. Returns whether it is new.
  bool add_note(const std::string& note);

  std::vector<EventRecord> finished_events;    // one per event
  std::vector<std::string> notes;              // in the order of their creation
  std::map<std::string, std::string> machine;  // further facts, by key
  // Tables and other files that another program keeps in the folder, see ExternalRecord.
  Tables tables;
  Files files;
  std::string ageing;  // settings of the ageing of the stack between events, as JSON; empty: none
  Files inputs;        // the files that the scene names, by their paths
  std::string scene;   // the checksum of scene.json, see scene_checksum
  std::string build;   // the build that wrote the record before, see build_id; empty if unknown
  double wall = 0;     // s, of the run so far
};

}  // namespace snowshed::run
