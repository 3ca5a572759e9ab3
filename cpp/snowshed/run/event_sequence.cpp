#include "snowshed/run/event_sequence.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "snowshed/core/build_id.hpp"
#include "snowshed/methods/capabilities.hpp"

namespace fs = std::filesystem;

namespace snowshed::run {

EventSequence EventSequence::create(const scene::Scene& scene, const fs::path& base_dir,
                                    const fs::path& folder, const StopRequest& stop,
                                    const methods::UserLaws& laws) {
  ResultsFolder::require_empty(folder);
  auto sim = std::make_unique<Simulation>(scene, base_dir, laws);
  sim->begin_event(stop);  // seeding may fail, and then nothing must be left behind
  RunRecord record;
  record.mark_inputs(sim->scene(), base_dir);
  ResultsFolder results = ResultsFolder::create(folder, sim->scene());
  return {std::move(sim), std::move(results), std::move(record)};
}

EventSequence EventSequence::resume(const scene::Scene& scene, const fs::path& base_dir,
                                    const fs::path& folder, const methods::UserLaws& laws) {
  ResultsFolder results = ResultsFolder::reopen(folder, scene);
  RunRecord record = RunRecord::read(results.record(), scene.numerics->info().energies);
  auto sim = fs::exists(results.checkpoint()) ? results.load_checkpoint(scene, laws)
                                              : std::make_unique<Simulation>(scene, base_dir, laws);
  record.keep_through(sim->event() - int(sim->event_running()));
  record.mark_inputs(sim->scene(), base_dir);
  if (scene.output.film && fs::exists(results.film())) sim->record_film(results.film());
  return {std::move(sim), std::move(results), std::move(record)};
}

EventSequence::EventSequence(std::unique_ptr<Simulation> sim, ResultsFolder folder,
                             RunRecord record)
    : sim_(std::move(sim)),
      folder_(std::move(folder)),
      record_(std::move(record)),
      steps_before_(0),
      wall_before_(0),
      earlier_wall_(record_.wall) {
  for (const EventRecord& record : record_.finished_events) {
    steps_before_ += record.steps;
    wall_before_ += record.wall;
  }
  const int finished_events = sim_->event() - int(sim_->event_running());
  // Folders of the previous version have no such record.
  if (int(record_.finished_events.size()) < finished_events)
    set_finished_work(sim_->method().counters().steps, earlier_wall_);
}

bool EventSequence::is_done() const {
  return !sim_->event_running() && sim_->event() >= sim_->scene().events.count;
}

bool EventSequence::run(EventObserver& observer, double report_interval) {
  const double every = sim_->scene().output.snapshot_interval;
  if (every > 0) sim_->write_snapshots(folder_.snapshots(), every);
  bool films = sim_->films();
  while (!is_done()) {
    bool stopped = observer.stop_requested();
    if (!stopped) try {
        begin_event(observer);  // seeding may take long
        if (sim_->scene().output.film && !std::exchange(films, true))
          sim_->record_film(folder_.film());  // its resolution depends on the snow
        stopped = observer.stop_requested();
      } catch (const Stopped&) {  // the last checkpoint has the same snow, before it aged
        return write_record(RunStatus::interrupted), false;
      }
    const RunEnd end = stopped ? RunEnd::paused : run_event(observer, report_interval);
    if (end == RunEnd::paused) return checkpoint(observer, RunStatus::interrupted), false;
    end_event(observer, end);
  }
  sim_->close_film();
  write_record(RunStatus::finished);
  return true;
}

void EventSequence::begin_event(EventObserver& observer) {
  std::optional<Reseeding> reseeding;
  if (!sim_->event_running()) {
    if (sim_->event() > 0) observer.between_events(*sim_);
    reseeding = sim_->begin_event([&] { return observer.stop_requested(); });
  }
  report_notes(observer);
  observer.event_begun(*sim_, reseeding);
}

void EventSequence::report_notes(EventObserver& observer) {
  if (const std::string earlier = std::exchange(record_.build, build_id());
      !earlier.empty() && earlier != build_id())
    note(observer, "the run was begun by the build " + earlier + " of snowshed, and resumed by " +
                       build_id());
  for (; reported_notes_ < sim_->notes().size(); ++reported_notes_)
    note(observer, sim_->notes()[reported_notes_]);
}

void EventSequence::note(EventObserver& observer, const std::string& text) {
  if (record_.add_note(text)) observer.noted(text);
}

/// Returns how the event ended; paused if the observer stopped it.
RunEnd EventSequence::run_event(EventObserver& observer, double report_interval) {
  const double every = sim_->scene().output.checkpoint_interval;
  while (true) {
    bool stopped = false;
    const auto go_on = [&](const RunReport& report) {
      observer.progress(*sim_, report);
      stopped = observer.stop_requested();
      return !stopped && !(every > 0 && since_checkpoint_.seconds() > every);
    };
    const RunEnd end = sim_->run(go_on, report_interval);
    if (end != RunEnd::paused || stopped) return end;
    checkpoint(observer, RunStatus::running);
  }
}

/// The checkpoint comes last: newer results are written again when the run is resumed.
void EventSequence::end_event(EventObserver& observer, RunEnd end) {
  EventRecord record;
  record.event = sim_->event();
  record.sim_time = sim_->event_time();
  record.steps = sim_->method().counters().steps - steps_before_;
  record.wall = std::max(wall() - wall_before_, 0.0);
  record.ended = end;
  record.laid_height = sim_->laid_height();
  const scene::Scene& scene = sim_->scene();
  record.damping_rate = scene.numerics->damping_rate(record.steps, record.sim_time);
  if (scene.output.energy)
    record.energy = methods::capability<methods::KeepsEnergy>(sim_->method())->energies();
  folder_.write_particles(*sim_);
  folder_.write_pressures(*sim_);
  observer.event_ended(*sim_, record);
  steps_before_ += record.steps;
  wall_before_ += record.wall;
  record_.finished_events.push_back(std::move(record));
  checkpoint(observer, RunStatus::running);
}

void EventSequence::checkpoint(EventObserver& observer, RunStatus status) {
  observer.before_checkpoint(*sim_);
  for (const std::string& name : folder_.write_forces(*sim_))
    record_.mark_file(folder_.path(), name);
  write_record(status);
  sim_->save(folder_.checkpoint());
  since_checkpoint_.restart();
}

void EventSequence::write_record(RunStatus status, const std::string& error) {
  record_.wall = wall();
  record_.scene = folder_.scene_checksum();
  record_.write(folder_.record(), *sim_, status, error);
  status_ = status;
}

/// Between two events the last checkpoint has the same snow, before it aged.
void EventSequence::record_failure(const std::string& error) {
  try {
    if (sim_->event_running()) sim_->save(folder_.checkpoint());
  } catch (const std::exception&) {  // the last good checkpoint stays
  }
  write_record(RunStatus::failed, error);
}

}  // namespace snowshed::run
