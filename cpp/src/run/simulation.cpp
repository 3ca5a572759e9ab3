#include "snowshed/run/simulation.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "run/snapshot_series.hpp"
#include "snowshed/geometry/build_shape.hpp"
#include "snowshed/geometry/combine.hpp"
#include "snowshed/geometry/particle_voxels.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/geometry/seeding.hpp"
#include "snowshed/geometry/voxel_set.hpp"
#include "snowshed/run/forecast.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/support/error.hpp"
#include "snowshed/support/timer.hpp"

namespace snowshed {
namespace {

/// The sides of the domain: six (in 2D four) half-spaces that snow sticks to.
std::vector<Obstacle> domain_walls(const Scene& scene) {
  std::vector<Obstacle> walls;
  if (!scene.domain) return walls;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && scene.dimension == 2) continue;
    const Vec3 inward = Vec3::Unit(axis);
    const ContactLaw sticky{Condition::sticky, 0.0};
    walls.push_back({"domain", make_plane(scene.domain->min, inward), sticky, std::nullopt});
    walls.push_back({"domain", make_plane(scene.domain->max, -inward), sticky, std::nullopt});
  }
  return walls;
}

std::vector<Obstacle> build_obstacles(const Scene& scene, const std::filesystem::path& base_dir) {
  std::vector<Obstacle> obstacles;
  const auto specs = assemble_obstacles(scene);
  const std::size_t own = specs.size() - scene.obstacles.size();  // ground and panel come first
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const ObstacleSpec& spec = specs[i];
    const std::string path =
        i < own ? "/" + spec.name : "/obstacles/" + std::to_string(i - own) + "/shape";
    Obstacle o{spec.name, build_shape(spec.shape, scene.dimension, path, base_dir),
               {spec.condition, spec.friction}, std::nullopt};
    if (spec.motion) o.motion.emplace(*spec.motion);
    obstacles.push_back(std::move(o));
  }
  for (Obstacle& wall : domain_walls(scene)) obstacles.push_back(std::move(wall));
  return obstacles;
}

SolverOptions solver_options(const Scene& scene) {
  SolverOptions o;
  o.dimension = scene.dimension;
  o.gravity = scene.gravity;
  o.snow = scene.snow;
  o.numerics = scene.numerics;
  o.energy = scene.output.energy;
  return o;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const std::filesystem::path& base_dir)
    : scene_(resolve(scene)),
      base_dir_(base_dir),
      rest_(scene.events.rest_speed, scene.events.rest_time) {
  const Forecast cost = forecast(scene_);
  check_memory(cost.bytes);
  expected_time_ = cost.event_time;
  solver_ = make_solver(solver_options(scene_), build_obstacles(scene_, base_dir_));
}

Simulation::~Simulation() = default;

int Simulation::threads() const {
  return scene_.numerics.threads > 0 ? scene_.numerics.threads : omp_get_num_procs();
}

std::optional<Reseeding> Simulation::begin_event() {
  if (running_) throw SimulationError("the present event has not ended yet");
  std::optional<Reseeding> reseeding;
  if (event_ > 0 && scene_.events.between == Between::reseed) reseeding = reseed_stack();
  const double lift = event_ > 0 ? lift_of_next_slab(solver_->state()) : 0.0;
  const auto bodies = assemble_bodies(scene_, event_ + 1, lift);
  event_mass_ = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    event_mass_ += lay(bodies[i], int(i), event_ + 1);
  ++event_;
  running_ = true;
  event_start_ = solver_->time();
  rest_.start_event(event_start_);
  return reseeding;
}

/// Seeds a body of snow; returns its mass.
double Simulation::lay(const BodySpec& body, int index, int event) {
  const Seeding& s = scene_.seeding;
  const bool slab = scene_.slab && index == 0;
  const std::string path =
      slab ? "/slab" : "/bodies/" + std::to_string(index - (scene_.slab ? 1 : 0)) + "/shape";
  try {
    const Shape shape = build_shape(body.shape, scene_.dimension, path, base_dir_);
    ParticleBatch batch;
    batch.positions = seed(*shape, scene_.dimension, scene_.numerics.dx, s.particles_per_voxel,
                           s.pattern, s.seed + 1000003u * std::uint64_t(event) + index);
    const double mass =
        scene_.snow.density * measure(*shape, scene_.dimension, scene_.numerics.dx);
    batch.mass = mass / double(batch.positions.size());
    batch.velocity = body.velocity;
    batch.event = event;
    solver_->add(batch);
    return mass;
  } catch (const InputError& error) {
    if (!error.where().empty() && error.where().front() == '/') throw;
    throw InputError(path, error.what());
  }
}

/// Later slabs lie on the snow that stayed on the panel; stray grains do not count.
double Simulation::lift_of_next_slab(const ParticleState& state) const {
  if (!scene_.panel || !scene_.slab) return 0.0;
  const PanelFrame frame = panel_frame(scene_);
  const std::vector<bool> there = on_panel(state);
  double mass = 0, top = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!there[i]) continue;
    mass += state.masses[i];
    top = std::max(top, frame.normal.dot(state.positions[i] - frame.center));
  }
  return mass > 0.02 * event_mass_ ? top + 0.5 * scene_.numerics.dx : 0.0;
}

std::vector<bool> Simulation::on_panel(const ParticleState& state) const {
  std::vector<bool> there(state.positions.size(), false);
  if (!scene_.panel) return there;
  const PanelFrame frame = panel_frame(scene_);
  const double dx = scene_.numerics.dx;
  // Above the face, no higher than all slabs so far together could lie.
  const double height =
      2 * dx + (scene_.slab ? scene_.slab->thickness : 0.0) * std::max(event_, 1);
  for (std::size_t i = 0; i < there.size(); ++i) {
    const Vec3 x = state.positions[i] - frame.center;
    const double above = frame.normal.dot(x);
    there[i] = above > -dx && above < height && std::abs(frame.slope.dot(x)) < 0.5 * frame.length &&
               (scene_.dimension == 2 || std::abs(x.y()) < 0.5 * frame.width);
  }
  return there;
}

/// The thesis's way between events (A.3.5): the stack as a solid, filled anew. The snow that
/// stayed on the panel is converted along with it, so nothing is lost.
Reseeding Simulation::reseed_stack() {
  const ParticleState old = solver_->state();
  const Seeding& s = scene_.seeding;
  const double dx = scene_.numerics.dx;
  const Shape solid = particles_to_level_set(
      old.positions, scene_.dimension, dx,
      particle_radius(scene_.dimension, dx, s.particles_per_voxel));
  ParticleBatch batch;
  batch.positions = seed(*solid, scene_.dimension, dx, s.particles_per_voxel, s.pattern,
                         s.seed + 1000003u * std::uint64_t(event_) + 500000u);
  double mass = 0;
  for (double m : old.masses) mass += m;
  batch.mass = mass / double(batch.positions.size());
  batch.event = event_;
  solver_->clear();
  solver_->add(batch);
  return {old.positions.size(),
          batch.positions.size(),
          mass,
          batch.mass * double(batch.positions.size()),
          old.positions,
          batch.positions,
          old.masses,
          std::vector<double>(batch.positions.size(), batch.mass)};
}

RunEnd Simulation::run(const std::function<bool(const RunReport&)>& observer, double interval) {
  if (!running_) throw SimulationError("no event is running; begin_event first");
  Stopwatch clock, since_start;
  const std::int64_t updates_at_start = solver_->counters().particle_updates;
  bool pausing = false;
  while (true) {
    if (pausing && solver_->at_safe_point()) return RunEnd::paused;
    if (snapshots_ && snapshots_->due(solver_->time())) snapshots_->write(*solver_, scene_.snow);
    if (rest_.due(solver_->time())) {
      const MotionSummary m = solver_->motion(scene_.events.rest_speed);
      const double speed = m.rms_speed * std::sqrt(m.mass / std::max(event_mass_, 1e-300));
      const bool rests = rest_.at_rest(solver_->time(), speed);
      if (rests || event_time() >= scene_.events.max_time) {
        running_ = false;
        return rests ? RunEnd::rest : RunEnd::time_limit;
      }
    }
    solver_->step();
    if (!pausing && clock.seconds() >= interval) {
      clock.restart();
      RunReport r = report(rest_.speed());
      r.updates_per_s = double(solver_->counters().particle_updates - updates_at_start) /
                        std::max(since_start.seconds(), 1e-9);
      pausing = !observer(r);
    }
  }
}

RunReport Simulation::report(double rms_speed) const {
  RunReport r;
  r.time = event_time();
  r.time_step = solver_->time_step();
  r.rms_speed = rms_speed;
  r.steps = solver_->counters().steps;
  r.particles = solver_->size();
  r.progress = std::min(0.99, r.time / std::max(expected_time_, 1e-9));
  return r;
}

void Simulation::write_snapshots(const std::filesystem::path& folder, double interval) {
  snapshots_ = std::make_unique<SnapshotSeries>(folder, interval, solver_->time());
}

void Simulation::write_vtp(const std::filesystem::path& file) const {
  write_particles(file, *solver_, scene_.snow);
}

}  // namespace snowshed
