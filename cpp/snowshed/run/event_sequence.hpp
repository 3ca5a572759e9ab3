// All events of a scene, one after the other, into a results folder: the one loop that both the
// executable and Python run.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "snowshed/core/stopwatch.hpp"
#include "snowshed/run/results_folder.hpp"
#include "snowshed/run/run_record.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed::run {

/// Observer of a sequence of events.
class EventObserver {
 public:
  virtual ~EventObserver() = default;

  /// Called before the next event begins; the snow may be settled then.
  virtual void between_events(Simulation&) {}
  /// Called when an event has begun or resumes; `reseeding` is the change of the stack before it.
  virtual void event_begun(const Simulation&, const std::optional<Reseeding>& /*reseeding*/) {}
  /// Called with a note on the snow that was just laid: a sentence that run.json will contain.
  virtual void noted(const std::string& /*note*/) {}
  virtual void progress(const Simulation&, const RunReport&) {}
  /// Called when an event has ended and its particles are in the folder, before its checkpoint.
  virtual void event_ended(const Simulation&, const EventRecord&) {}
  /// Called before a checkpoint is written; records that must match it are saved now.
  virtual void before_checkpoint(const Simulation&) {}
  /// Called at every report, between events and while snow is seeded; true interrupts the sequence.
  virtual bool stop_requested() { return false; }
};

class EventSequence {
 public:
  /// Begins a run in a folder that is new or empty. The first snow is laid before anything is
  /// written. Throws InputError, and Stopped on request.
  static EventSequence create(const scene::Scene& scene, const std::filesystem::path& base_dir,
                              const std::filesystem::path& folder, const StopRequest& stop = {},
                              const methods::UserLaws& laws = {});

  /// Continues an earlier run of the same scene, by any program, from the last checkpoint in its
  /// folder; without a checkpoint the run begins again. Throws InputError.
  static EventSequence resume(const scene::Scene& scene, const std::filesystem::path& base_dir,
                              const std::filesystem::path& folder,
                              const methods::UserLaws& laws = {});

  /// Runs the remaining events, with a report every `report_interval` seconds of wall time.
  /// Checkpoints are written at the scene's output.checkpoint_interval and after each event.
  /// Returns false if the observer stopped the run. A checkpoint is written first, except during
  /// seeding, because the last checkpoint has the same snow. Exceptions of the simulation or the
  /// observer pass through.
  bool run(EventObserver&, double report_interval);

  /// Records in run.json that the run cannot continue. During an event, a checkpoint keeps the last
  /// sound state.
  void record_failure(const std::string& error);

  /// Releases the folder to another run. This sequence must not run afterwards.
  void close() { folder_.unlock(); }

  Simulation& simulation() { return *sim_; }
  const RunRecord& record() const { return record_; }

 private:
  friend class ExternalRecord;

  EventSequence(std::unique_ptr<Simulation>, ResultsFolder, RunRecord);

  /// Sets the steps and the wall time (s) of the finished events.
  void set_finished_work(std::int64_t steps, double wall) {
    steps_before_ = steps;
    wall_before_ = wall;
  }
  bool is_done() const;
  void begin_event(EventObserver&);
  void report_notes(EventObserver&);
  void note(EventObserver&, const std::string& text);
  RunEnd run_event(EventObserver&, double report_interval);
  void end_event(EventObserver&, RunEnd);
  void checkpoint(EventObserver&, RunStatus);
  void write_record(RunStatus, const std::string& error = "");
  double wall() const { return earlier_wall_ + clock_.seconds(); }

  std::unique_ptr<Simulation> sim_;
  ResultsFolder folder_;
  RunRecord record_;
  std::optional<RunStatus> status_;    // in run.json, as it was written last
  std::size_t reported_notes_ = 0;     // number of the simulation's notes that were reported
  std::int64_t steps_before_;          // the present event
  double wall_before_, earlier_wall_;  // s, before the present event and before resuming
  Stopwatch clock_, since_checkpoint_;
};

}  // namespace snowshed::run
