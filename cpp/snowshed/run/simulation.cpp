#include "snowshed/run/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/core/timer.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/particles/point_grid.hpp"
#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/run/snapshot_series.hpp"
#include "snowshed/sampling/particle_voxels.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/sampling/voxel_set.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/build_shape.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/shape_measure.hpp"

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
    Obstacle o{spec.name,
               build_shape(spec.shape, scene.dimension, path, base_dir),
               {spec.condition, spec.friction},
               std::nullopt};
    if (spec.motion) o.motion.emplace(*spec.motion);
    obstacles.push_back(std::move(o));
  }
  for (Obstacle& wall : domain_walls(scene)) obstacles.push_back(std::move(wall));
  return obstacles;
}

/// For each point the particle nearest to it, all of them within `reach` of one.
std::vector<std::size_t> nearest_particles(const std::vector<Vec3>& points,
                                           const std::vector<Vec3>& particles, double reach) {
  const PointGrid grid(particles, reach);
  std::vector<std::size_t> found;
  for (const Vec3& x : points) {
    std::size_t at = particles.size() - 1;
    double nearest = std::numeric_limits<double>::infinity();
    grid.for_each_near(x, [&](std::size_t i, const Vec3& y) {
      const double distance = (x - y).squaredNorm();
      if (distance >= nearest) return;
      nearest = distance;
      at = i;
    });
    found.push_back(at);
  }
  return found;
}

int material_id_of(const ParticleState& particles, std::size_t i) {
  return particles.material_ids.empty() ? 0 : particles.material_ids[i];
}

/// Shares out the mass of old particles among the new ones that stand for them (`old_of`): each
/// snow keeps its mass, in equal parts. That of a snow without new particles goes to all.
std::vector<double> share_masses(const ParticleState& old, const std::vector<std::size_t>& old_of,
                                 std::size_t snows) {
  std::vector<double> mass(snows), count(snows);
  for (std::size_t i = 0; i < old.masses.size(); ++i) mass[material_id_of(old, i)] += old.masses[i];
  for (const std::size_t i : old_of) ++count[material_id_of(old, i)];
  double placed = 0, left = 0;
  for (std::size_t k = 0; k < snows; ++k) (count[k] > 0 ? placed : left) += mass[k];
  std::vector<double> masses;
  for (const std::size_t i : old_of) {
    const int material_id = material_id_of(old, i);
    masses.push_back(mass[material_id] / count[material_id] * (1 + left / placed));
  }
  return masses;
}

/// Geometry knows no scene; gives its errors the place in it.
template <class Action>
auto naming(const std::string& path, Action action) {
  try {
    return action();
  } catch (const InputError& error) {
    if (!error.where().empty() && error.where().front() == '/') throw;
    throw InputError(path, error.what());
  } catch (const SimulationError& error) {  // beyond the addressable grid
    throw InputError(path, error.what());
  }
}

std::string body_path(std::size_t i) { return "/bodies/" + std::to_string(i) + "/shape"; }

/// Where in the scene the bodies of `assemble_bodies` stand.
std::vector<std::string> body_paths(const Scene& scene, int event) {
  std::vector<std::string> paths;
  if (scene.slab) {
    const auto& layers = scene.slab->layers;
    if (layers.empty()) paths.push_back("/slab");
    for (std::size_t i = 0; i < layers.size(); ++i)
      if (is_laid_in(layers[i], event)) paths.push_back("/slab/layers/" + std::to_string(i));
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (is_laid_in(scene.bodies[i], event)) paths.push_back(body_path(i));
  return paths;
}

/// What the scene tells of a body's volume (m3, in 2D m2); else it is measured, coarsely, in the
/// solid itself, whose files are read here before anything is run.
double body_volume(const BodySpec& body, const Scene& scene, const std::string& path,
                   const std::filesystem::path& base_dir) {
  if (const auto told = shape_volume(body.shape, scene.dimension)) return *told;
  return naming(path, [&] {
    const Shape shape = build_shape(body.shape, scene.dimension, path, base_dir);
    const Vec3 size = shape->bounds().max - shape->bounds().min;
    return measure(*shape, scene.dimension, std::max(scene.numerics.dx, size.maxCoeff() / 64));
  });
}

/// New particles in each event.
std::vector<double> count_particles(const Scene& scene, const std::filesystem::path& base_dir) {
  std::vector<double> counts = estimate_cost(scene).particles;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodySpec& body = scene.bodies[i];
    const double volume = body_volume(body, scene, body_path(i), base_dir);
    const double count =
        volume / std::pow(scene.numerics.dx, scene.dimension) * scene.seeding.particles_per_voxel;
    if (count < 0.5) throw InputError(body_path(i), "too small to hold a particle; reduce dx");
    if (shape_volume(body.shape, scene.dimension)) continue;  // counted already
    for (int event = 1; event <= scene.events.count; ++event)
      if (is_laid_in(body, event)) counts[std::size_t(event - 1)] += count;
  }
  return counts;
}

/// Of the slab laid at the start of an event, kg.
double slab_mass(const Scene& scene, int event) {
  double mass = 0;
  for (const BodySpec& layer : assemble_slab(scene, event))
    mass += snow_of(scene, layer).density * shape_volume(layer.shape, scene.dimension).value();
  return mass;
}

/// Whether a point lies above or below the panel's face, seen along its normal.
bool is_over(const PanelFrame& panel, const Vec3& point, int dimension) {
  const Vec3 x = point - panel.center;
  return std::abs(panel.slope.dot(x)) < 0.5 * panel.length &&
         (dimension == 2 || std::abs(x.y()) < 0.5 * panel.width);
}

MpmOptions solver_options(const Scene& scene) {
  MpmOptions o;
  o.dimension = scene.dimension;
  o.gravity = scene.gravity;
  o.snows = assemble_snows(scene);
  o.numerics = scene.numerics;
  o.energy = scene.output.energy;
  return o;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const std::filesystem::path& base_dir)
    : scene_(resolve(scene)),
      snows_(assemble_snows(scene_)),
      base_dir_(base_dir),
      cost_(estimate_cost(scene_, count_particles(scene_, base_dir))),
      rest_(scene.events.rest_speed, scene.events.rest_time) {
  check_memory(cost_.bytes);
  std::vector<Obstacle> all = build_obstacles(scene_, base_dir_);
  const auto first = all.begin() + int(scene_.ground.has_value()) + int(scene_.panel.has_value());
  obstacles_.assign(first, first + std::ptrdiff_t(scene_.obstacles.size()));
  solver_ = make_mpm(solver_options(scene_), std::move(all));
}

Simulation::~Simulation() = default;

int Simulation::threads() const { return threads_to_use(scene_.numerics.threads); }

std::optional<Reseeding> Simulation::begin_event() {
  if (running_) throw SimulationError("the present event has not ended yet");
  std::optional<Reseeding> reseeding;
  if (event_ > 0 && scene_.events.between == Between::reseed) reseeding = reseed_stack();
  const double lift = lift_of_next_slab();
  const auto bodies = assemble_bodies(scene_, event_ + 1, lift);
  event_mass_ = 0;
  const auto paths = body_paths(scene_, event_ + 1);
  const std::size_t layers = assemble_slab(scene_, event_ + 1).size();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const SeededBody laid = seed_body(
        bodies[i], paths[i], scene_.seeding.seed + 1000003u * std::uint64_t(event_ + 1) + i);
    event_mass_ += laid.mass;
    if (i >= layers) laid_height_ += laid.height;
  }
  if (scene_.slab) laid_height_ += slab_thickness(*scene_.slab, event_ + 1);
  ++event_;
  running_ = true;
  event_start_ = solver_->time();
  rest_.start_event(event_start_);
  return reseeding;
}

/// Seeds a body of snow.
Simulation::SeededBody Simulation::seed_body(const BodySpec& body, const std::string& path,
                                             std::uint64_t seed) {
  return naming(path, [&] {
    const Shape shape = build_shape(body.shape, scene_.dimension, path, base_dir_);
    ParticleBatch batch;
    batch.positions =
        snowshed::seed(*shape, scene_.dimension, scene_.numerics.dx,
                       scene_.seeding.particles_per_voxel, scene_.seeding.pattern, seed);
    const Snow& snow = snow_of(scene_, body);
    const double mass = snow.density * measure(*shape, scene_.dimension, scene_.numerics.dx);
    batch.mass = mass / double(batch.positions.size());
    batch.velocity = body.velocity;
    batch.event = event_ + 1;
    batch.material_id = snowshed::material_id_of(snow, snows_);
    solver_->add(batch);
    return SeededBody{mass, height_over_panel(batch.positions)};
  });
}

/// Later slabs lie on the snow that stayed on the panel; stray grains do not count.
double Simulation::lift_of_next_slab() const {
  const double next_mass = slab_mass(scene_, event_ + 1);
  if (event_ == 0 || next_mass == 0) return 0.0;
  const PanelFrame frame = panel_frame(scene_);
  const ParticleState state = solver_->state();
  const std::vector<bool> there = on_panel(state.positions);
  double mass = 0, top = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!there[i]) continue;
    mass += state.masses[i];
    top = std::max(top, frame.normal.dot(state.positions[i] - frame.center));
  }
  const double last_mass = event_mass_ > 0 ? event_mass_ : next_mass;
  return mass > 0.02 * std::min(last_mass, next_mass) ? top + 0.5 * scene_.numerics.dx : 0.0;
}

double Simulation::height_over_panel(const std::vector<Vec3>& positions) const {
  if (!scene_.panel) return 0.0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const PanelFrame frame = panel_frame(scene_);
  for (const Vec3& x : positions) {
    if (!is_over(frame, x, scene_.dimension)) continue;
    const double above = frame.normal.dot(x - frame.center);
    low = std::min(low, above);
    high = std::max(high, above);
  }
  return std::max(0.0, high - low);
}

void Simulation::settle(const std::vector<double>& drops,
                        const std::vector<double>& plastic_changes) {
  if (running_) throw InputError("settling", "an event is running; snow settles between events");
  solver_->settle(drops, plastic_changes);
}

std::vector<bool> Simulation::on_panel(const std::vector<Vec3>& positions) const {
  std::vector<bool> there(positions.size(), false);
  if (!scene_.panel) return there;
  const PanelFrame frame = panel_frame(scene_);
  const double dx = scene_.numerics.dx;
  // Above the face, no higher than all snow so far together could lie.
  const double height = 2 * dx + laid_height_;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const double above = frame.normal.dot(positions[i] - frame.center);
    there[i] = above > -dx && above < height && is_over(frame, positions[i], scene_.dimension);
  }
  return there;
}

double Simulation::obstacle_distance(const Vec3& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& o : obstacles_)
    nearest =
        std::min(nearest, o.shape->distance(o.motion ? o.motion->to_body(x, solver_->time()) : x));
  return nearest;
}

/// The thesis's way between events (A.3.5): the stack as a solid, filled anew. The snow that
/// stayed on the panel is converted along with it, so nothing is lost.
Reseeding Simulation::reseed_stack() try {
  ParticleState old = solver_->state();
  const Seeding& s = scene_.seeding;
  const double dx = scene_.numerics.dx;
  const Shape solid =
      particles_to_level_set(old.positions, scene_.dimension, dx,
                             particle_radius(scene_.dimension, dx, s.particles_per_voxel));
  Reseeding::Cloud after;
  after.positions = seed(*solid, scene_.dimension, dx, s.particles_per_voxel, s.pattern,
                         s.seed + 1000003u * std::uint64_t(event_) + 500000u);
  after.on_panel = on_panel(after.positions);
  const auto old_of = nearest_particles(after.positions, old.positions, 1.5 * dx);
  after.masses = share_masses(old, old_of, snows_.size());

  std::map<std::pair<int, int>, ParticleBatch> batches;  // by event and kind
  for (std::size_t i = 0; i < old_of.size(); ++i) {
    const int event = old.events[old_of[i]], material_id = material_id_of(old, old_of[i]);
    ParticleBatch& batch = batches[{event, material_id}];
    batch.positions.push_back(after.positions[i]);
    batch.mass = after.masses[i];
    batch.event = event;
    batch.material_id = material_id;
    after.densities.push_back(snows_[std::size_t(material_id)].density);
  }
  std::vector<ParticleBatch> all;
  for (auto& [_, batch] : batches) all.push_back(std::move(batch));
  solver_->replace(all);

  Reseeding::Cloud before;
  for (std::size_t i = 0; i < old.masses.size(); ++i)
    before.densities.push_back(snows_[std::size_t(material_id_of(old, i))].density);
  before.positions = std::move(old.positions);
  before.masses = std::move(old.masses);
  before.on_panel = on_panel(before.positions);
  return {std::move(before), std::move(after)};
} catch (const InputError& error) {
  throw SimulationError(std::string("cannot reseed the stack: ") + error.what());
}

RunEnd Simulation::run(const std::function<bool(const RunReport&)>& observer, double interval) {
  if (!running_) throw SimulationError("no event is running; begin_event first");
  Stopwatch clock, since_start;
  const std::int64_t updates_at_start = solver_->counters().particle_updates;
  bool pausing = false;
  while (true) {
    if (pausing && solver_->at_safe_point()) return RunEnd::paused;
    if (snapshots_ && snapshots_->due(solver_->time())) snapshots_->write(*solver_);
    if (rest_.due(solver_->time())) {
      const MotionSummary m = solver_->motion(scene_.events.rest_speed);
      const double brought = event_mass_ > 0 ? event_mass_ : m.mass;
      const double speed = m.rms_speed * std::sqrt(m.mass / std::max(brought, 1e-300));
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

void Simulation::step(int count) {
  if (!running_) throw SimulationError("no event is running; begin_event first");
  for (int i = 0; i < count; ++i) solver_->step();
}

RunReport Simulation::report(double rms_speed) const {
  RunReport r;
  r.time = event_time();
  r.time_step = solver_->time_step();
  r.rms_speed = rms_speed;
  r.steps = solver_->counters().steps;
  r.particles = solver_->size();
  r.progress = std::min(0.99, r.time / std::max(cost_.event_time, 1e-9));
  return r;
}

void Simulation::write_snapshots(const std::filesystem::path& folder, double interval) {
  snapshots_ = std::make_unique<SnapshotSeries>(folder, interval, solver_->time());
}

void Simulation::write_vtp(const std::filesystem::path& file) const {
  write_particles(file, *solver_);
}

}  // namespace snowshed
