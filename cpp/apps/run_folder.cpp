#include "run_folder.hpp"

#include <cstdio>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/timer.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/pvd_series.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace fs = std::filesystem;

namespace snowshed {
namespace {

void require_empty(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(folder.string(), "is not a folder");
  if (fs::is_directory(folder) && !fs::is_empty(folder))
    throw InputError(folder.string(), "is not empty; choose a new folder, or --resume");
}

class FolderRun {
 public:
  FolderRun(fs::path folder, std::unique_ptr<Simulation> sim, bool quiet)
      : folder_(std::move(folder)),
        sim_(std::move(sim)),
        quiet_(quiet),
        updates_before_(sim_->solver().counters().particle_updates) {}

  bool all(const std::function<bool()>& go_on) {
    const Scene& scene = sim_->scene();
    if (scene.output.snapshot_interval > 0)
      sim_->write_snapshots(folder_ / "snapshots", scene.output.snapshot_interval);
    while (sim_->event_running() || sim_->event() < scene.events.count) {
      if (!go_on()) return checkpoint(), false;
      if (!sim_->event_running()) sim_->begin_event();
      if (!one_event(go_on)) return false;
    }
    return true;
  }

  void checkpoint() const { sim_->save(folder_ / "checkpoint.bin"); }

  void write_run(const char* status) const {
    const StepCounters& c = sim_->solver().counters();
    std::ostringstream json;
    json << "{\n  \"version\": \"" << SNOWSHED_VERSION << "\",\n  \"kernels\": \""
         << kernel_variant() << "\",\n  \"threads\": " << sim_->threads()
         << ",\n  \"events\": " << sim_->event() << ",\n  \"particles\": " << sim_->solver().size()
         << ",\n  \"steps\": " << c.steps << ",\n  \"rejected_steps\": " << c.rejected
         << ",\n  \"particle_updates\": " << c.particle_updates
         << ",\n  \"slept_updates\": " << c.slept_updates << ",\n  \"updates_per_s\": "
         << double(c.particle_updates - updates_before_) / clock_.seconds()
         << ",\n  \"peak_memory_mb\": " << double(peak_resident_bytes()) / 1e6
         << ",\n  \"wall_s\": " << clock_.seconds() << ",\n  \"status\": \"" << status << "\"\n}\n";
    write_atomic(folder_ / "run.json", json.str());
  }

 private:
  bool one_event(const std::function<bool()>& go_on) {
    Stopwatch since_checkpoint;
    const double every = sim_->scene().output.checkpoint_interval;
    while (true) {
      bool stop = false;
      const auto observer = [&](const RunReport& r) {
        if (!quiet_)
          std::fprintf(stderr, "\revent %d  %3.0f %%  t = %.3f s  %.1f M updates/s ", sim_->event(),
                       100 * r.progress, r.time, r.updates_per_s / 1e6);
        stop = !go_on();
        return !stop && !(every > 0 && since_checkpoint.seconds() > every);
      };
      const RunEnd end = sim_->run(observer, 0.1);
      if (end != RunEnd::paused) {
        finish_event(end);
        return true;
      }
      checkpoint();
      since_checkpoint.restart();
      if (stop) return false;
    }
  }

  void finish_event(RunEnd end) {
    char name[32];
    std::snprintf(name, sizeof name, "event_%03d.vtp", sim_->event());
    fs::create_directories(folder_ / "particles");
    sim_->write_vtp(folder_ / "particles" / name);
    PvdSeries::reopen(folder_ / "particles.pvd", sim_->event())
        .append(sim_->event(), std::string("particles/") + name);
    checkpoint();
    if (!quiet_)
      std::fprintf(stderr, "\revent %d  %s after %.3f s of snow time%30s\n", sim_->event(),
                   end == RunEnd::rest ? "at rest" : "time limit", sim_->event_time(), "");
  }

  fs::path folder_;
  std::unique_ptr<Simulation> sim_;
  bool quiet_;
  std::int64_t updates_before_;  // by the run that is resumed
  Stopwatch clock_;
};

}  // namespace

bool run_into_folder(const Scene& scene, const fs::path& folder, bool resume, bool quiet,
                     const std::function<bool()>& go_on) {
  std::unique_ptr<Simulation> sim;
  if (resume) {
    if (!fs::is_regular_file(folder / "checkpoint.bin"))
      throw InputError(folder.string(), "nothing to resume; it holds no checkpoint.bin");
    sim = Simulation::load(folder / "checkpoint.bin");
    if (write_scene(sim->scene()) != write_scene(resolve(scene)))
      throw InputError(folder.string(), "was made by another scene");
  } else {
    require_empty(folder);
    sim = std::make_unique<Simulation>(scene);
    sim->begin_event();  // seeding may fail too, and then nothing must be left behind
    fs::create_directories(folder);
    write_atomic(folder / "scene.json", write_scene(sim->scene()));
  }
  FolderRun run(folder, std::move(sim), quiet);
  try {
    const bool finished = run.all(go_on);
    run.write_run(finished ? "finished" : "interrupted");
    return finished;
  } catch (const FileError&) {
    throw;
  } catch (const std::exception&) {
    run.checkpoint();
    run.write_run("failed");
    throw;
  }
}

}  // namespace snowshed
