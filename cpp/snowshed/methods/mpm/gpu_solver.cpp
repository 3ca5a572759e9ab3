#include "snowshed/methods/mpm/gpu_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/gpu/device_snow.hpp"
#include "snowshed/methods/mpm/gpu_support.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"
#include "snowshed/methods/mpm/time_step.hpp"
#include "snowshed/methods/unwatched.hpp"

namespace snowshed::methods::mpm {
namespace {

using gpu::Control;
using gpu::Phase;

/// Nodes beside their block that the particles of a block touch, as BlockStats::reach.
int reach_of(const gpu::CellRange& cells) {
  int reach = 0;
  for (int d = 0; d < 3; ++d) {
    if (cells.low[d] < 0) reach |= below(d);
    if (cells.high[d] + support(Basis::quadratic) > gpu::edge) reach |= above(d);
  }
  return reach;
}

/// `host_` has the state in the form of all other calls; between them and the steps, the particles
/// go to the device and back.
class GpuSolver final : public Solver, public AdvancesUnwatched {
 public:
  GpuSolver(Options options, std::shared_ptr<snowshed::gpu::Device> device)
      : device_(std::move(device)),
        host_(std::make_unique<SolverImpl<float, 3>>(std::move(options))),
        snow_(*device_, host_->model()),
        touch_(Basis::quadratic) {}

  using Method::add;
  void add(const std::vector<ParticleBatch>& batches, const StopRequest& stop) override {
    edited().add(batches, stop);
  }
  void replace(const std::vector<ParticleBatch>& batches) override { edited().replace(batches); }
  void add_velocity(const std::vector<Vec3>& changes) override { edited().add_velocity(changes); }
  void settle(const std::vector<double>& drops,
              const std::vector<double>& plastic_changes) override {
    edited().settle(drops, plastic_changes);
  }
  void load(const io::BinaryReader& in) override { edited().load(in); }

  void step() override { take_steps(std::numeric_limits<double>::infinity(), 1); }
  void advance(double until) override {
    take_steps(until, std::numeric_limits<std::int32_t>::max());
  }

  bool at_safe_point() const override { return since_sort_ < 0; }
  std::size_t size() const override { return host_->size(); }
  double time() const override { return host_->time(); }
  double time_step() const override { return host_->time_step(); }
  const StepCounters& counters() const override { return host_->counters(); }
  ParticleState state() const override { return current().state(); }
  std::vector<particles::FieldInfo> fields() const override { return host_->fields(); }
  particles::FieldView field(const std::string& name) const override {
    return current().field(name);
  }
  const std::vector<std::uint32_t>& order_by_id() const override { return current().order_by_id(); }
  MotionSummary motion(double speed) const override { return current().motion(speed); }
  NamedEnergies energies() const override { return current().energies(); }
  const ObstacleForces* forces() const override { return host_->forces(); }
  void begin_force_event() override {
    with_contacts([this] { host_->begin_force_event(); });
  }
  std::vector<ForceSample> sample_forces(double duration) override {
    std::vector<ForceSample> samples;
    current();
    with_contacts([&] { samples = host_->sample_forces(duration); });
    return samples;
  }
  RestingForces resting_forces(bool at_rest) const override {
    return current().resting_forces(at_rest);
  }
  std::int64_t sorts() const override { return host_->sorts(); }
  std::int64_t slept_updates() const override { return host_->slept_updates(); }
  std::size_t bytes() const override { return host_->bytes() + snow_.bytes(); }
  void save(io::BinaryWriter& out) const override { current().save(out); }
  void check(const io::BinaryReader& in) const override { host_->check(in); }

 private:
  /// The processor's solver with the present particles.
  SolverImpl<float, 3>& current() const {
    if (device_is_ahead_) snow_.download(host_->state_for_device());
    device_is_ahead_ = false;
    return *host_;
  }
  /// The same, to be changed.
  SolverImpl<float, 3>& edited() {
    SolverImpl<float, 3>& solver = current();
    device_has_snow_ = false;
    since_sort_ = -1;
    return solver;
  }

  /// Calls f with the host's contacts up to date. The device adopts the changes by f.
  template <class F>
  void with_contacts(const F& f) {
    if (device_has_snow_) snow_.download_contacts(host_->state_for_device());
    f();
    if (device_has_snow_) snow_.upload_contacts(host_->state_for_device());
  }

  void take_steps(double until, std::int32_t steps);
  void prepare();
  void record_forces(std::int64_t steps);
  void hold_sleeping_forces();
  void update_touch();
  double end_of_batch(double until) const;
  Control begin_batch(double until, std::int32_t steps);
  void end_batch(const Control& control);
  [[noreturn]] void fail(Control control);
  void update_sleep();
  std::int32_t steps_to_the_next_check() const;

  std::shared_ptr<snowshed::gpu::Device> device_;
  std::unique_ptr<SolverImpl<float, 3>> host_;
  gpu::DeviceSnow snow_;
  Touch<float, 3> touch_;  // contact by touch, if the settings ask for it
  Control control_{};
  mutable bool device_is_ahead_ = false;  // whether its particles are newer than the host's
  bool device_has_snow_ = false;          // whether it has the snow of the host's state
  int since_sort_ = -1;                   // steps; negative: a sort is due
  int until_sort_ = steps_between_sorts;
};

/// Sorts the particles, and computes the sums of the grid, if this is due.
void GpuSolver::prepare() {
  if (since_sort_ >= 0) return;
  State<float, 3>& state = host_->state_for_device();
  if (!device_has_snow_) snow_.upload(state);
  device_has_snow_ = true;
  device_is_ahead_ = true;
  snow_.sort(state);
  ++state.totals.sorts;
  control_.speed_squared = float(state.totals.speed * state.totals.speed);
  control_.phase = Phase::waiting;
  snow_.scatter(control_);
  snow_.find_event_contacts();
  if (state.forces) with_contacts([this] { hold_sleeping_forces(); });
  if (host_->model().touches()) touch_.forget(host_->model(), state);
  since_sort_ = 0;
  until_sort_ = steps_until_sort(state.particles.size(), state.contacts.size());
}

std::int32_t GpuSolver::steps_to_the_next_check() const {
  if (host_->model().boundary.any_motion()) return 1;
  const State<float, 3>& state = host_->state_of_device();
  if (!state.sleep.allowed()) return until_sort_ - since_sort_;
  const std::int32_t check =
      steps_between_checks - std::int32_t(counters().steps % steps_between_checks);
  return std::min(check, until_sort_ - since_sort_);
}

Control GpuSolver::begin_batch(double until, std::int32_t steps) {
  device_is_ahead_ = true;
  State<float, 3>& state = host_->state_for_device();
  if (host_->model().boundary.any_motion())
    with_contacts([&] { state.follow_obstacles(host_->model(), host_->model().max_threads); });
  if (host_->model().touches()) update_touch();
  Control c = control_;
  c.travel = 0;
  c.travel_limit = std::numeric_limits<double>::infinity();
  if (host_->model().touches()) c.travel_limit = touch_.reserve(state);
  c.time = time();
  c.until = end_of_batch(until);
  c.smallest_dt = counters().smallest_dt;
  c.steps = counters().steps;
  c.rejected = counters().rejected;
  c.undamped_steps = state.totals.undamped_steps;
  c.undamped_time = state.totals.undamped_time;
  c.steps_left = steps;
  c.taken = 0;
  c.must_sort = 0;
  c.unsound = gpu::no_particle;
  return c;
}

/// Finds the contacts that act, where snow may have moved far enough. The particles of the blocks
/// around obstacles come to the host.
void GpuSolver::update_touch() {
  const Model<float, 3>& model = host_->model();
  State<float, 3>& state = host_->state_for_device();
  const std::vector<std::int32_t> due = touch_.due_blocks(model, state);
  if (due.empty()) return;
  snow_.download_blocks(state, due);
  with_contacts([&] { touch_.measure(model, state, due, model.max_threads); });
}

void GpuSolver::take_steps(double until, std::int32_t steps) {
  host_->require_sound();
  if (size() == 0) throw SimulationError("there is no snow to simulate");
  while (steps > 0 && time() < until) {
    prepare();
    const std::int32_t batch = std::min(steps, steps_to_the_next_check());
    const std::int64_t before = counters().steps;
    control_ = begin_batch(until, batch);
    // All at once, unless the time is over before.
    const double left = (control_.until - time()) / std::max(control_.last_dt, 1e-12);
    int rounds = int(std::min(double(batch), std::max(left + 1, 1.0)));
    do {
      snow_.run(control_, rounds);
      rounds = std::max(1, control_.steps_left);
    } while (control_.phase == Phase::trying);
    end_batch(control_);
    steps -= std::int32_t(counters().steps - before);
  }
}

void GpuSolver::end_batch(const Control& c) {
  StepTotals& totals = host_->state_for_device().totals;
  const std::int64_t steps = c.steps - totals.counters.steps;
  const std::int64_t awake = host_->state_of_device().sleep.awake_particles();
  totals.time = c.time;
  if (steps > 0) totals.dt = c.last_dt;
  totals.speed = std::sqrt(double(c.speed_squared));
  totals.counters.steps = c.steps;
  if (c.phase != Phase::stuck) totals.counters.rejected = c.rejected;
  totals.counters.smallest_dt = c.smallest_dt;
  totals.undamped_steps = c.undamped_steps;
  totals.undamped_time = c.undamped_time;
  totals.counters.particle_updates += steps * awake;
  totals.slept_updates += steps * (std::int64_t(size()) - awake);
  snow_.replay_energies(host_->state_for_device(), steps);
  record_forces(steps);
  touch_.travel(c.travel);
  since_sort_ += int(steps);
  if (c.must_sort || since_sort_ >= until_sort_) since_sort_ = -1;
  if (c.phase == Phase::stuck || c.phase == Phase::unsound) fail(c);
  update_sleep();
}

/// Returns the time at which the host must look, at the latest.
double GpuSolver::end_of_batch(double until) const {
  const std::optional<ForceRecord>& forces = host_->state_of_device().forces;
  if (!forces) return until;
  const double end = forces->forces.pressures().half_end();
  return end > time() ? std::min(until, end) : until;
}

/// Gives the host's record the steps of a batch.
void GpuSolver::record_forces(std::int64_t steps) {
  State<float, 3>& state = host_->state_for_device();
  if (!state.forces || steps == 0) return;
  snow_.replay_forces(state, steps);
  if (state.forces->forces.pressures().half_is_over(time()))
    with_contacts([&] { state.end_pressure_half(host_->model()); });
}

void GpuSolver::hold_sleeping_forces() {
  State<float, 3>& state = host_->state_for_device();
  std::vector<gpu::CellRange> ranges;
  if (!state.sleep.idle().empty()) ranges = snow_.cell_ranges_asleep();
  state.hold_sleeping_forces(host_->model(), [&](std::int32_t g) {
    const auto& around = state.layout.around_nodes[std::size_t(g)];
    for (int k = 0; k < gpu::neighbours; ++k)
      if (around[k] >= 0 &&
          reaches<3>(reach_of(ranges[std::size_t(around[k])]), gpu::neighbours - 1 - k))
        return true;
    return false;
  });
}

void GpuSolver::fail(Control c) {
  SolverImpl<float, 3>& solver = edited();
  control_ = {};
  if (c.phase == Phase::unsound) solver.fail_at(c.unsound);
  State<float, 3>& state = solver.state_for_device();
  for (std::size_t g = 0; g < state.layout.grid_blocks.size(); ++g) state.contacts.reject(g);
  for (EventContact<float>& c : state.event_contacts) c.next_impulse = c.impulse;
  throw SimulationError(describe_stuck(c.dt, c.time, double(c.strain_of_step),
                                       solver.model().options.settings.strain_limit));
}

void GpuSolver::update_sleep() {
  State<float, 3>& state = host_->state_for_device();
  if (!state.sleep.allowed() || counters().steps % steps_between_checks != 0) return;
  const std::vector<gpu::BlockMotion> motions = snow_.motions(state.sleep);
  const auto count = [&](std::int32_t b) {
    return double(state.layout.first[b + 1] - state.layout.first[b]);
  };
  Sleep<3>::BlockProbe probe;
  probe.fastest = [&](std::int32_t b) { return std::sqrt(double(motions[b].fastest)); };
  probe.speed = [&](std::int32_t b) { return std::sqrt(motions[b].speed_squared / count(b)); };
  probe.velocity = [&](std::int32_t b) {
    return VecD<3>(VecD<3>::Map(motions[b].velocity) / count(b));
  };
  probe.carried = [&](std::int32_t b) {
    SleepingBlockMotion motion;
    motion.speed_squared = motions[b].carried / motions[b].mass;
    for (int d = 0; d < 3; ++d) motion.change[d] = motions[b].change[d] / motions[b].mass;
    return motion;
  };
  probe.obstacle_moves = [&](std::int32_t b) {
    const auto& around = state.layout.around_particles[b];
    return host_->model().boundary.any_motion() &&
           std::any_of(around.begin(), around.end(),
                       [&](std::int32_t g) { return state.contacts.moves(std::size_t(g)); });
  };
  probe.holds_its_snow = [&](std::int32_t b) { return motions[b].holds_its_snow != 0; };
  const std::int64_t awake = state.sleep.awake_particles();
  const std::vector<std::int32_t> idle = state.sleep.idle();
  const std::vector<std::int32_t> asleep =
      state.sleep.update(state.layout, time(), steps_between_checks, time_step(), probe);
  if (asleep.empty() && awake == state.sleep.awake_particles()) return;
  state.totals.energy.put_to_sleep(snow_.kinetic_energy(asleep));
  snow_.stop(asleep);
  snow_.upload_sleep(state);
  if (since_sort_ >= 0) snow_.scatter(control_);
  if (!state.forces || idle == state.sleep.idle()) return;
  with_contacts([&] {
    state.collect_forces(host_->model(), idle);
    hold_sleeping_forces();
  });
}

}  // namespace

std::unique_ptr<Solver> make_gpu_solver(Options options,
                                        std::shared_ptr<snowshed::gpu::Device> device) {
  require_supported_on_gpu(options);
  return std::make_unique<GpuSolver>(std::move(options), std::move(device));
}

}  // namespace snowshed::methods::mpm
