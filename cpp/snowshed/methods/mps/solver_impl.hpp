// The solver of the MPS method: its data, and the order of its parts.
#pragma once

#include <optional>

#include "snowshed/methods/mps/energy.hpp"
#include "snowshed/methods/mps/forces.hpp"
#include "snowshed/methods/particle_method.hpp"

namespace snowshed::methods::mps {

/// Mass and momentum of all particles.
template <int D>
Momentum momentum_of(const Particles<D>&);

/// A step builds the next state beside the present one, and can fail only before it takes the next
/// one over. A failed step therefore never leaves unsound particles, and the class has no
/// Soundness.
template <int D>
class SolverImpl final : public Solver {
 public:
  explicit SolverImpl(Options options)
      : model_(std::move(options)), energy_recorder_(model_.options.energy) {
    if (model_.options.forces)
      forces_.emplace(model_.options.obstacles, D, model_.settings().spacing);
    workspace_.records_forces = model_.options.forces;
    if (model_.has_wall_particles())
      workspace_.walls =
          WallParticles<D>(model_.options.obstacles, model_.settings().spacing, model_.reach());
  }

  using Method::add;
  void add(const std::vector<ParticleBatch>&, const StopRequest&) override;
  void replace(const std::vector<ParticleBatch>&) override;
  void add_velocity(const std::vector<Vec3>&) override;

  void step() override;
  bool at_safe_point() const override { return true; }
  double time() const override { return state_.time; }
  double time_step() const override { return state_.dt; }
  const StepCounters& counters() const override { return state_.counters; }

  std::vector<particles::FieldInfo> fields() const override;
  particles::FieldView field(const std::string&) const override;
  const std::vector<std::uint32_t>& order_by_id() const override {
    return order_.of(state_.particles.id);
  }

  std::size_t size() const override { return state_.particles.size(); }
  ParticleState state() const override;
  MotionSummary motion(double speed) const override;
  NamedEnergies energies() const override;
  const ObstacleForces* forces() const override { return forces_ ? &*forces_ : nullptr; }
  void begin_force_event() noexcept override;
  std::vector<ForceSample> sample_forces(double duration) override;
  RestingForces resting_forces(bool at_rest) const override;
  std::size_t bytes() const override;

  void save(io::BinaryWriter&) const override;
  void load(const io::BinaryReader&) override;
  void check(const io::BinaryReader&) const override;

  Report report() const override;
  ReportsRun::Section run_section() const override;

 private:
  void append(State<D>&, const ParticleBatch&) const;
  void accept(State<D>);
  double solve_step(const State<D>& start, State<D>& next);
  void try_step(double dt, State<D>& next);
  void apply_viscosity(double dt, State<D>& next);
  bool is_coupled(double dt) const;
  void solve_pressure_first(double dt, State<D>& next);
  void solve_with_expected_force(double dt, State<D>& next);
  void solve_viscosity_first(double dt, State<D>& next);
  void move(double dt, Particles<D>&) const;
  double choose_step(const Particles<D>&) const;
  double pressure_step(const Particles<D>&) const;
  double largest_speed(const Particles<D>&) const;
  void record_drag(double dt, const Particles<D>&);
  void find_wall_impulses(double dt, const State<D>& next);
  void record_wall_impulses() noexcept;
  void end_balance() noexcept;
  State<D> read_state(const io::BinaryReader&) const;
  std::optional<ObstacleForces> read_forces(const io::BinaryReader&, const State<D>&) const;
  template <class Visit>
  void visit_fields(Visit) const;

  Model<D> model_;
  State<D> state_;
  Workspace<D> workspace_;
  EnergyRecorder<D> energy_recorder_;
  std::optional<ObstacleForces> forces_;  // if the options ask for it
  IdOrder order_;
};

}  // namespace snowshed::methods::mps
