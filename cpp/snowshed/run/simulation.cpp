#include "snowshed/run/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/core/stopwatch.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/unwatched.hpp"
#include "snowshed/run/apply_laws.hpp"
#include "snowshed/run/energy_history.hpp"
#include "snowshed/run/film_recorder.hpp"
#include "snowshed/run/force_history.hpp"
#include "snowshed/run/record_times.hpp"
#include "snowshed/run/shape_fingerprints.hpp"
#include "snowshed/run/snapshot_series.hpp"
#include "snowshed/run/snow_placement.hpp"
#include "snowshed/scene/build_obstacles.hpp"
#include "snowshed/scene/build_surroundings.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

/// Share of a step by which rounding may shorten an event.
constexpr double rounding_of_step = 1e-6;

/// The mean distance of particles as they are seeded, m.
double particle_distance(const scene::Scene& scene) {
  const double per_voxel =
      scene.numerics.takes(methods::Part::seeding) ? scene.seeding.particles_per_voxel : 1;
  return scene.numerics->resolution() / std::pow(per_voxel, 1.0 / scene.dimension);
}

}  // namespace

Simulation::Simulation(const scene::Scene& scene, const std::filesystem::path& base_dir,
                       const methods::UserLaws& laws)
    : scene_(scene::resolve(scene)),
      scene_text_(scene::write_scene(scene_)),
      base_dir_(base_dir),
      panel_(scene_),
      rest_(scene.events.rest_speed, scene.events.rest_time) {
  const bool takes_bodies = scene_.numerics.takes(methods::Part::bodies);
  if (takes_bodies) {  // from the scene, before anything is built
    cost_ = estimate_cost(scene_, count_particles(scene_, base_dir));
    check_cost();
  }
  shape_fingerprints_ = shape_fingerprints(scene_, base_dir_);
  surroundings_ = scene::build_surroundings(scene_, base_dir_);
  apply_laws(laws, scene_, surroundings_);
  notes_ = surroundings_.notes;
  listed_obstacles_ = scene::listed_obstacles(scene_, surroundings_.obstacles);
  resolved_obstacles_ = scene::listed_obstacles(scene_, surroundings_.resolved);
  surroundings_.device =
      scene_.numerics->choose_device(scene::view_of(scene_), surroundings_, cost_);
  if (!device().note.empty()) notes_.push_back(device().note);
  method_ = empty_method();
  if (!takes_bodies) {
    const methods::SceneView view = scene::view_of(scene_);
    cost_ = scene_.numerics->cost_of_method(view, surroundings_, *method_);
    check_cost();
  }
  if (const auto* measured = methods::capability<methods::HasCurve>(std::as_const(*method_)))
    curve_ = measured->empty_curve();
  else if (scene_.output.energy)
    energies_ = std::make_unique<EnergyHistory>(scene_.numerics->info().energies,
                                                record_interval(scene_, cost_));
  if (scene_.output.forces)
    forces_ = std::make_unique<ForceHistory>(*method_, scene_.output.force_interval);
}

Simulation::~Simulation() = default;

void Simulation::check_cost() const {
  check_memory(cost_.bytes);
  check_duration(scene_, cost_);
}

/// The scene's method with its obstacles, before any snow.
std::unique_ptr<methods::Method> Simulation::empty_method() const {
  return scene_.numerics->build(scene::view_of(scene_), surroundings_);
}

std::string Simulation::input_note() const {
  return surroundings_.input ? surroundings_.input->note() : "";
}

const EnergyHistory& Simulation::energy_history() const {
  if (!energies_)
    throw InputError("/output/energy", curve_ ? "the curve of this method has the energies"
                                              : "false; energies are kept only if it is true");
  return *energies_;
}

int Simulation::threads() const { return threads_to_use(scene_.numerics->threads()); }

std::optional<Reseeding> Simulation::begin_event(const StopRequest& stop) {
  if (running_) throw SimulationError("the present event has not ended yet");
  std::optional<Reseeding> reseeding;
  if (event_ > 0 && scene_.events.between == methods::Between::reseed)
    reseeding = reseed_stack(scene_, panel_, method_->state(), event_, laid_height_, stop);
  const double lift = lift_of_next_slab(reseeding);
  SeededSnow snow = seed_next_event(lift, stop);
  std::vector<std::string> notes = check_placement_of(snow, reseeding);
  change_snow(reseeding, std::move(snow.batches), stop);
  event_mass_ = snow.mass;
  laid_height_ += snow.height_on_panel;
  ++event_;
  notes_.insert(notes_.end(), notes.begin(), notes.end());
  running_ = true;
  event_start_ = method_->time();
  rest_.start_event(event_start_);
  rests_ = false;
  if (curve_) curve_->record(*method_);
  if (forces_) forces_->begin_event(*method_, event_);
  return reseeding;
}

SeededSnow Simulation::seed_next_event(double lift, const StopRequest& stop) const {
  if (const auto* seeding = methods::capability<methods::SeedsItself>(std::as_const(*method_)))
    return seeded(seeding->seed(stop));
  return seed_event(scene_, base_dir_, panel_, event_ + 1, lift, stop);
}

/// Returns notes on the new snow; throws InputError if it lies where snow may not be. A slab that
/// is laid where the stack has grown up to the panel only gives a note, so that a winter can
/// continue.
std::vector<std::string> Simulation::check_placement_of(
    const SeededSnow& snow, const std::optional<Reseeding>& reseeding) const {
  std::vector<std::string> notes;
  std::vector<PlacedBody> bodies;
  for (std::size_t i = 0; i < snow.bodies.size(); ++i) {
    const SeededBody& body = snow.bodies[i];
    bodies.push_back(
        {body.path, &snow.batches[i].positions, body.shape, body.is_of_slab && event_ > 0});
  }
  OccupiedSpace space{surroundings_.obstacles,   surroundings_.resolved,
                      method_->time(),           {},
                      particle_distance(scene_), event_ + 1};
  if (reseeding) {
    const std::vector<Vec3>& stack = reseeding->after.positions;
    notes = check_placement(scene_, {{"the reseeded stack", &stack, nullptr, true}}, space);
    space.particles = stack;
  } else if (!bodies.empty()) {
    space.particles = positions();
  }
  const std::vector<std::string> of_bodies = check_placement(scene_, bodies, space);
  notes.insert(notes.end(), snow.notes.begin(), snow.notes.end());
  notes.insert(notes.end(), of_bodies.begin(), of_bodies.end());
  return notes;
}

std::vector<Vec3> Simulation::positions() const {
  const particles::FieldView view = method_->field("position");
  std::vector<Vec3> positions;
  positions.reserve(method_->size());
  for (std::size_t i = 0; i < method_->size(); ++i)
    positions.push_back(Vec3::Map(view.at<double>(i)));
  return positions;
}

/// Takes a step of the present event; unwatched, steps up to the next time at which an output, the
/// rest or the end of the event is due.
void Simulation::advance(bool unwatched) {
  const double before = method_->time();
  // These histories look at every step.
  unwatched = unwatched && methods::capability<methods::AdvancesUnwatched>(*method_) && !curve_ &&
              !energies_ && !forces_;
  if (unwatched)
    method_->advance(next_look());
  else
    method_->step();
  if (!(method_->time() > before))
    throw SimulationError("the time stays at " + show(before) + " s: a step of " +
                          show(method_->time_step()) + " s is too short to add to it");
  if (curve_) curve_->record(*method_);
}

/// The time (s) of the next output or decision. At least one step is left until then.
double Simulation::next_look() const {
  double next = event_start_ + scene_.events.max_time - rounding_of_step * method_->time_step();
  next = std::min(next, rest_.next());
  if (snapshots_) next = std::min(next, snapshots_->next());
  if (film_) next = std::min(next, film_->next_time());
  return std::max(next, std::nextafter(method_->time(), std::numeric_limits<double>::infinity()));
}

/// Makes the only change to the particles at the beginning of an event, all or nothing.
void Simulation::change_snow(const std::optional<Reseeding>& reseeding,
                             std::vector<methods::ParticleBatch> added,
                             const StopRequest& stop) try {
  if (!reseeding) return method_->add(added, stop);
  added.insert(added.begin(), reseeding->batches.begin(), reseeding->batches.end());
  method_->replace(added);
} catch (const SimulationError& error) {  // beyond the addressable grid
  throw InputError("/", error.what());
}

void Simulation::add_snow(methods::ParticleBatch batch) {
  batch.event = std::max(event_, 1);
  std::vector<std::string> notes;
  if (scene_.numerics.takes(methods::Part::bodies))
    notes = check_placement(scene_, {{"positions", &batch.positions}},
                            {surroundings_.obstacles, surroundings_.resolved, method_->time(),
                             positions(), particle_distance(scene_), event_});
  method_->add(batch);
  notes_.insert(notes_.end(), notes.begin(), notes.end());
  event_mass_ += batch.total_mass();
  laid_height_ += panel_.height_of(batch.positions);
}

/// Later slabs lie on the snow that stayed on the panel; stray grains do not count.
double Simulation::lift_of_next_slab(const std::optional<Reseeding>& reseeding) const {
  const double next_mass = slab_mass(scene_, event_ + 1);
  if (event_ == 0 || next_mass == 0) return 0.0;
  const PanelRegion::Layer left =
      panel_.snow_on(reseeding ? as_held(reseeding->batches) : method_->state(), laid_height_);
  const double last_mass = event_mass_ > 0 ? event_mass_ : next_mass;
  return left.mass > 0.02 * std::min(last_mass, next_mass) ? left.top + 0.5 * resolution() : 0.0;
}

/// The particles of batches, rounded to the method's precision.
methods::ParticleState Simulation::as_held(
    const std::vector<methods::ParticleBatch>& batches) const {
  const std::unique_ptr<methods::Method> method = empty_method();
  method->add(batches);
  return method->state();
}

void Simulation::settle(const std::vector<double>& drops,
                        const std::vector<double>& plastic_changes) {
  if (running_) throw InputError("settling", "an event is running; snow settles between events");
  if (auto* settling = methods::capability<methods::Settles>(*method_))
    return settling->settle(drops, plastic_changes);
  for (const auto* changes : {&drops, &plastic_changes})
    if (std::any_of(changes->begin(), changes->end(), [](double change) { return change != 0; }))
      throw InputError("settling", "snow of this method does not settle between events");
}

/// Signed distance to the nearest obstacle, at its position at the given time, m.
static double nearest_distance(const std::vector<methods::Obstacle>& obstacles, double time,
                               const Vec3& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const methods::Obstacle& o : obstacles)
    nearest = std::min(nearest, o.shape->distance(o.motion ? o.motion->to_body(x, time) : x));
  return nearest;
}

double Simulation::obstacle_distance(const Vec3& x) const {
  return nearest_distance(listed_obstacles_, method_->time(), x);
}

double Simulation::resolved_distance(const Vec3& x) const {
  return nearest_distance(resolved_obstacles_, method_->time(), x);
}

RunEnd Simulation::run(const std::function<bool(const RunReport&)>& observer, double interval) {
  if (!running_) throw SimulationError("no event is running; begin_event first");
  Stopwatch clock, since_start;
  const std::int64_t updates_at_start = method_->counters().particle_updates;
  bool pausing = false;
  while (true) {
    if (pausing && method_->at_safe_point()) return RunEnd::paused;
    record();
    if (const auto end = event_end()) {
      if (film_) film_->record_end(*method_, event_);
      if (energies_) energies_->record_end(*method_, event_);
      if (forces_) forces_->end_event(*method_, *end == RunEnd::rest);
      running_ = false;
      return *end;
    }
    advance(!pausing);
    if (!pausing && clock.seconds() >= interval) {
      clock.restart();
      RunReport r = report(rest_.speed());
      r.updates_per_s = double(method_->counters().particle_updates - updates_at_start) /
                        std::max(since_start.seconds(), 1e-9);
      pausing = !observer(r);
    }
  }
}

/// Writes the outputs that are due now.
void Simulation::record() {
  if (snapshots_ && snapshots_->due(method_->time())) snapshots_->write(*method_);
  if (energies_) energies_->record(*method_, event_);
  if (forces_) forces_->record(*method_);
  if (film_ && film_->due({event_, running_, method_->time()})) film_->record(*method_, event_);
}

/// The reason for the end of the event, or none while it runs. The last step is not shortened,
/// so it may end beyond the time limit. A step that ends before the limit by rounding alone has
/// reached it.
std::optional<RunEnd> Simulation::event_end() {
  const bool rests = at_rest();
  if (event_time() <= 0) return std::nullopt;  // snow cannot have been at rest for zero seconds
  if (rests) return RunEnd::rest;
  if (event_time() >= scene_.events.max_time - rounding_of_step * method_->time_step())
    return RunEnd::time_limit;
  return std::nullopt;
}

bool Simulation::at_rest() {
  if (const std::optional<bool> method_rests = method_->at_rest()) return *method_rests;
  if (rest_.due(method_->time())) rests_ = detect_rest();
  return rests_;
}

bool Simulation::detect_rest() {
  const methods::MotionSummary m = method_->motion(scene_.events.rest_speed);
  const double brought = event_mass_ > 0 ? event_mass_ : m.mass;
  const double speed = m.rms_speed * std::sqrt(m.mass / std::max(brought, 1e-300));
  return rest_.at_rest(method_->time(), speed);
}

Simulation::Pressures Simulation::pressures() const {
  Pressures p;
  if (!forces_) return p;
  const auto& keeping = *methods::capability<methods::KeepsForces>(std::as_const(*method_));
  const methods::ObstacleForces& forces = *keeping.forces();
  p.rest = keeping.resting_forces(forces_->ended_at_rest()).pressures;
  for (const methods::Patch& patch : forces.pressures().patches()) {
    const std::vector<Vec3> corners = forces.pressures().corners(patch);
    const auto& motion = surroundings_.resolved[std::size_t(patch.obstacle())].motion;
    for (const Vec3& corner : corners) {
      const Vec3 x = motion ? motion->at(method_->time()).to_world(corner) : corner;
      p.corners.push_back({x[0], x[1], x[2]});
    }
    p.per_patch = corners.size();
    p.obstacle.push_back(std::int32_t(forces.name_of(patch.obstacle())));
    p.area.push_back(patch.area);
    p.peak.push_back(patch.peak);
    p.peak_time.push_back(patch.peak_time);
  }
  return p;
}

void Simulation::step(int count) {
  if (!running_) throw SimulationError("no event is running; begin_event first");
  for (int i = 0; i < count; ++i) {
    at_rest();  // rest is a matter of time, so that each step counts
    advance(false);
  }
}

RunReport Simulation::report(double rms_speed) const {
  RunReport r;
  r.time = event_time();
  r.time_step = method_->time_step();
  r.rms_speed = rms_speed;
  r.steps = method_->counters().steps;
  r.particles = method_->size();
  const double progress = method_->progress().value_or(r.time / std::max(cost_.event_time, 1e-9));
  r.progress = std::min(0.99, progress);
  return r;
}

void Simulation::write_snapshots(const std::filesystem::path& folder, double interval) {
  snapshots_ = std::make_unique<SnapshotSeries>(folder, interval, method_->time());
}

void Simulation::record_film(const std::filesystem::path& file) {
  film_ =
      std::make_unique<FilmRecorder>(file, film_header(scene_, *method_, cost_),
                                     RunPosition{event_, running_, method_->time()}, film_mark_);
}

void Simulation::close_film() {
  if (film_) film_->close();
}

std::optional<io::FilmMark> Simulation::film_mark() const {
  return film_ ? film_->mark() : film_mark_;
}

void Simulation::write_vtp(const std::filesystem::path& file) const {
  write_particles(file, *method_);
}

}  // namespace snowshed::run
