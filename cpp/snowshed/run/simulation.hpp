// A scene being simulated, in memory: one slide-off event after another onto the stack.
// `EventSequence` drives it through all events and keeps a results folder.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/io/film_file.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/surroundings.hpp"
#include "snowshed/run/body_seeding.hpp"
#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/run/panel_region.hpp"
#include "snowshed/run/reseeding.hpp"
#include "snowshed/run/rest_detector.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::io {
class BinaryReader;
}
namespace snowshed::methods {
class Curve;
}

namespace snowshed::run {

class EnergyHistory;
class ForceHistory;
class FilmRecorder;
class SnapshotSeries;

/// Reason for which `Simulation::run` returned.
enum class RunEnd { rest, time_limit, paused };

/// Report to an observer while an event runs.
struct RunReport {
  double time = 0;       // s, in this event
  double time_step = 0;  // s
  double rms_speed = 0;  // m/s
  double progress = 0;   // estimated part of the event that is done, 0 to 1
  double updates_per_s = 0;
  std::int64_t steps = 0;
  std::size_t particles = 0;
};

class Simulation {
 public:
  /// Builds obstacles, reads all files and checks that the scene fits into memory; seeds nothing
  /// yet. Relative file names are looked for in `base_dir`. Throws InputError.
  explicit Simulation(const scene::Scene& scene, const std::filesystem::path& base_dir = ".",
                      const methods::UserLaws& laws = {});
  ~Simulation();

  /// Seeds the next event's snow: the slab on the panel (above the snow that remained there, unless
  /// that is less than 2 % of the slab and of the last event's snow) and the scene's bodies. With
  /// between = "reseed", the stack is reseeded from the second event on (`reseed_stack`). All or
  /// nothing: throws InputError if the snow of this event cannot be seeded, or lies where snow may
  /// not be (snow_placement.hpp), SimulationError if the stack cannot be converted or an event
  /// still runs, and Stopped on request. The simulation is then unchanged.
  std::optional<Reseeding> begin_event(const StopRequest& stop = {});

  /// Runs the present event until the snow rests or the time limit is reached. `observer` is called
  /// every `interval` seconds of wall time. If it returns false, the run continues to the next safe
  /// point, so that a checkpoint resumes to the same bits, and returns `paused`. Another call
  /// resumes the event.
  RunEnd run(const std::function<bool(const RunReport&)>& observer, double interval);

  /// Adds particles of the present event, beside those that begin_event seeds. Particles that are
  /// added before the first event belong to the first event. `batch.event` is set here. Throws
  /// InputError if the particles lie where snow may not be.
  void add_snow(methods::ParticleBatch batch);

  /// Takes `count` steps of the present event, whether the snow rests or not. Callers that drive
  /// the snow themselves can change velocities between steps by `add_velocity`.
  void step(int count = 1);
  void add_velocity(const std::vector<Vec3>& velocity_changes) {
    method_->add_velocity(velocity_changes);
  }

  /// Applies the effects of time on the snow between two events, see Settles. Throws InputError
  /// while an event runs, and for changes to snow of a method that does not settle.
  void settle(const std::vector<double>& drops, const std::vector<double>& plastic_changes);

  /// Writes a snapshot to `folder` every `interval` seconds of simulated time from now on.
  void write_snapshots(const std::filesystem::path& folder, double interval);

  /// Records the particles into a film from now on, or continues the film of the run that was
  /// resumed: its frames after the present state are recorded again. Throws InputError if that
  /// film is damaged.
  void record_film(const std::filesystem::path& file);
  bool films() const { return film_ != nullptr; }
  void close_film();  ///< no frame will follow
  /// The mark of the film as it is now, or as it was when the loaded checkpoint was made.
  std::optional<io::FilmMark> film_mark() const;

  /// Writes a checkpoint, which replaces an older one only once it has been read back. Throws
  /// SimulationError if no run could resume from it, and FileError if it cannot be written; the
  /// older file then stays.
  void save(const std::filesystem::path& checkpoint) const;
  /// Throws InputError if the file is not a sound checkpoint. Threads and device are those of
  /// the scene `machine`; null: of the checkpoint's scene. Any number of threads gives the same
  /// bits, another device the same results to rounding. Laws of the user must be given again, under
  /// the same name.
  static std::unique_ptr<Simulation> load(const std::filesystem::path& checkpoint,
                                          const scene::Scene* machine = nullptr,
                                          const methods::UserLaws& laws = {});
  /// The same for another scene, which may lay other snow from the next event on, or have more
  /// events. It must have the same method and obstacles, and its snows must begin with those of the
  /// checkpoint's scene. Also throws InputError if an event was running.
  static std::unique_ptr<Simulation> load_into(const scene::Scene&,
                                               const std::filesystem::path& base_dir,
                                               const std::filesystem::path& checkpoint);

  const scene::Scene& scene() const { return scene_; }
  /// Indexed by material_id.
  const std::vector<material::Snow>& snows() const { return surroundings_.snows; }
  /// The laws of the user; none by default.
  const methods::UserLaws& laws() const { return surroundings_.laws; }
  const methods::CostEstimate& cost() const { return cost_; }
  /// The device on which the steps are computed.
  const methods::DeviceChoice& device() const { return surroundings_.device; }
  const methods::Method& method() const { return *method_; }
  /// The curve measured after each step so far; null for methods without such a curve.
  const methods::Curve* curve() const { return curve_.get(); }
  /// A note on the files that the method reads; empty if there is none.
  std::string input_note() const;
  /// The energies over time that `run` recorded. Throws InputError if the scene does not keep them,
  /// or if a curve has them.
  const EnergyHistory& energy_history() const;
  /// The forces on obstacles that `run` recorded; null unless the scene asks for them.
  const ForceHistory* force_history() const { return forces_.get(); }
  /// The pressures on the faces of obstacles after an event, at rest and at their largest, with the
  /// faces where they are now.
  struct Pressures {
    std::vector<std::array<double, 3>> corners;       // m, of one patch after the other
    std::size_t per_patch = 0;                        // number of corners
    std::vector<std::int32_t> obstacle;               // place in the names of the history
    std::vector<double> area, rest, peak, peak_time;  // m2, Pa, Pa, s
  };
  Pressures pressures() const;
  int event() const { return event_; }
  /// Notes for readers of the results on the snow that was laid since this object was made, a
  /// sentence each.
  const std::vector<std::string>& notes() const { return notes_; }
  bool event_running() const { return running_; }
  /// Whether the snow has come to rest, as `run` decides it.
  bool at_rest();
  double event_time() const { return method_->time() - event_start_; }
  int threads() const;

  /// The smallest length that is resolved, m.
  double resolution() const { return scene_.numerics->resolution(); }

  /// Mean rate of numerical damping so far, 1/s.
  std::optional<double> damping_rate() const {
    return scene_.numerics->damping_rate(method_->counters().steps, method_->time());
  }

  /// Height that all snow laid so far would have on the panel if none had left it, m.
  double laid_height() const { return laid_height_; }

  /// Returns for each position whether snow there lies on the panel, now or at the time when the
  /// snow laid so far had the given height.
  std::vector<bool> on_panel(const std::vector<Vec3>& positions) const {
    return on_panel(positions, laid_height_);
  }
  std::vector<bool> on_panel(const std::vector<Vec3>& positions, double laid_height) const {
    return panel_.contains(positions, laid_height);
  }

  /// Signed distance to the nearest obstacle of the scene's list at its present position, m;
  /// ground, panel and domain do not count. Infinite without obstacles.
  double obstacle_distance(const Vec3& x) const;

  /// The same for the obstacles with thickened thin parts, on which snow lies.
  double resolved_distance(const Vec3& x) const;

  /// One .vtp with all particles and their quantities.
  void write_vtp(const std::filesystem::path&) const;

 private:
  double lift_of_next_slab(const std::optional<Reseeding>&) const;
  methods::ParticleState as_held(const std::vector<methods::ParticleBatch>&) const;
  SeededSnow seed_next_event(double lift, const StopRequest& stop) const;
  std::vector<std::string> check_placement_of(const SeededSnow&,
                                              const std::optional<Reseeding>&) const;
  std::vector<Vec3> positions() const;
  void check_cost() const;
  void change_snow(const std::optional<Reseeding>&, std::vector<methods::ParticleBatch> added,
                   const StopRequest& stop);
  void advance(bool unwatched);
  double next_look() const;
  void record();
  bool detect_rest();
  std::optional<RunEnd> event_end();
  std::unique_ptr<methods::Method> empty_method() const;
  static std::unique_ptr<Simulation> from_archive(const io::BinaryReader&, const scene::Scene&,
                                                  const std::filesystem::path& base_dir,
                                                  const methods::UserLaws& laws = {});
  void read_back(const std::filesystem::path& checkpoint) const;
  RunReport report(double rms_speed) const;

  scene::Scene scene_;
  // Text for checkpoints, made in advance: the JSON library would end the process if memory ran
  // out.
  std::string scene_text_;
  std::vector<std::int64_t> shape_fingerprints_;  // files that shapes are read from
  std::filesystem::path base_dir_;
  methods::CostEstimate cost_;
  PanelRegion panel_;
  methods::Surroundings surroundings_;
  // The obstacles of the scene's list, as given and thickened.
  std::vector<methods::Obstacle> listed_obstacles_, resolved_obstacles_;
  std::unique_ptr<methods::Method> method_;
  std::unique_ptr<SnapshotSeries> snapshots_;
  std::unique_ptr<FilmRecorder> film_;
  std::optional<io::FilmMark> film_mark_;    // in the checkpoint that was loaded
  std::unique_ptr<methods::Curve> curve_;    // for methods that have one
  std::unique_ptr<EnergyHistory> energies_;  // for methods without a curve, if output.energy is set
  std::unique_ptr<ForceHistory> forces_;     // if output.forces is set
  RestDetector rest_;
  bool rests_ = false;  // as detected last
  std::vector<std::string> notes_;
  int event_ = 0;
  bool running_ = false;
  double event_start_ = 0;  // s
  double event_mass_ = 0;   // kg, laid by the present event
  double laid_height_ = 0;  // m
};

}  // namespace snowshed::run
