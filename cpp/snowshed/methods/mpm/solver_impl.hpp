// The solver for one precision and dimension.
#pragma once

#include <optional>
#include <string>

#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/event_contacts.hpp"
#include "snowshed/methods/mpm/grid.hpp"
#include "snowshed/methods/mpm/model.hpp"
#include "snowshed/methods/mpm/solver.hpp"
#include "snowshed/methods/mpm/state.hpp"
#include "snowshed/methods/mpm/touch.hpp"
#include "snowshed/methods/mpm/velocity_average.hpp"
#include "snowshed/methods/particle_method.hpp"

namespace snowshed::methods::mpm {

/// Data that is computed from a state. It may be dropped before any sort.
template <class T, int D>
struct Workspace {
  Workspace(const Settings& n, std::size_t obstacles)
      : grid(n.basis), friction_shares(obstacles), touch(n.basis), event_contacts(n.basis) {
    if (n.damps_over_length()) average.emplace(n.damping_length, n.dx, n.basis);
  }

  Grid<T, D> grid;
  std::optional<VelocityAverage<T, D>> average;
  FrictionShares<T> friction_shares;
  Touch<T, D> touch;
  EventContacts<T, D> event_contacts;
  std::vector<double> block_strain;  // 1/s, of the step being tried
  std::vector<std::int32_t> idle_before;
  bool tiles_valid = false;  // whether the tiles hold the sums of the particles
  int since_sort = 0;        // steps
  int until_sort = steps_between_sorts;
};

template <class T, int D>
class SolverImpl final : public Solver {
 public:
  explicit SolverImpl(Options options);

  using Method::add;
  void add(const std::vector<ParticleBatch>&, const StopRequest&) override;
  void replace(const std::vector<ParticleBatch>&) override;
  void add_velocity(const std::vector<Vec3>& velocity_changes) override;
  void settle(const std::vector<double>& drops,
              const std::vector<double>& plastic_changes) override;
  void step() override;
  bool at_safe_point() const override { return !workspace_.tiles_valid; }
  std::size_t size() const override { return state_.particles.size(); }
  double time() const override { return state_.totals.time; }
  double time_step() const override { return state_.totals.dt; }
  const StepCounters& counters() const override { return state_.totals.counters; }
  ParticleState state() const override;
  std::vector<particles::FieldInfo> fields() const override;
  particles::FieldView field(const std::string& name) const override;
  const std::vector<std::uint32_t>& order_by_id() const override {
    return state_.particles.order_by_id();
  }
  MotionSummary motion(double speed) const override;
  NamedEnergies energies() const override { return named_energies(state_.energy(model_)); }
  const ObstacleForces* forces() const override {
    return state_.forces ? &state_.forces->forces : nullptr;
  }
  void begin_force_event() noexcept override;
  std::vector<ForceSample> sample_forces(double duration) override;
  RestingForces resting_forces(bool at_rest) const override;
  std::int64_t sorts() const override { return state_.totals.sorts; }
  std::int64_t slept_updates() const override { return state_.totals.slept_updates; }
  std::size_t bytes() const override;
  void save(io::BinaryWriter&) const override;
  void load(const io::BinaryReader&) override;
  void check(const io::BinaryReader&) const override;

  // --- for a device that takes the steps in place of this solver ---------------------------------

  const Model<T, D>& model() const { return model_; }
  /// The state, which the device may change as steps do. The grid of this solver is then obsolete.
  State<T, D>& state_for_device() {
    workspace_.tiles_valid = false;
    return state_;
  }
  const State<T, D>& state_of_device() const { return state_; }
  void require_sound() const { soundness_.require(); }
  /// Makes the solver fail because of a particle that is not sound.
  [[noreturn]] void fail_at(std::int32_t particle);

 private:
  State<T, D> read_state(const io::BinaryReader&) const;
  void read_forces(const io::BinaryReader&, State<T, D>& next) const;

  // The phases of a step.
  double try_step();  ///< returns the length of the step
  void sort();
  void scatter();
  double shorten_to_limits(double dt);  ///< returns the accepted dt
  void gather_and_update(double dt);
  void gather(std::int32_t grid_block);
  void update(double dt);
  void update_block(const StepParameters<T>& step, std::ptrdiff_t block);
  void finish_block(const StepParameters<T>& step, std::ptrdiff_t block);
  void add_body_force(const StepParameters<T>& step, std::ptrdiff_t block);
  void clear_block(const StepParameters<T>& step, std::ptrdiff_t block);
  bool has_overlap(std::int32_t grid_block) const {
    return !state_.layout.has_overlap.empty() && state_.layout.has_overlap[grid_block];
  }
  void update_overlaps(const StepParameters<T>& step);
  void update_overlap(const StepParameters<T>& step, std::ptrdiff_t overlap);
  double largest_strain();  ///< largest velocity gradient of a particle, 1/s
  void g2p2g(double dt);
  bool damps_next() const;  ///< whether the next step damps velocities over a length
  void average_velocities(double dt) noexcept;
  void record_step(double dt) noexcept;
  void record_damping(double dt) noexcept;
  void record_forces(double dt) noexcept;
  void hold_sleeping_forces() noexcept;
  void update_sleep() noexcept;
  typename Sleep<D>::BlockProbe block_probe();
  BlockStats probe(const StepParameters<T>& step, const ParticleView<T>& view, std::int32_t block);
  void rest_idle_nodes();
  void scatter_block(const StepParameters<T>& step, const ParticleView<T>& view,
                     std::ptrdiff_t block);

  StepParameters<T> parameters(double dt) const;
  int threads() const { return model_.threads(state_.sleep.awake_particles()); }
  void velocities_around(std::int32_t block, const T* (&velocities)[neighbour_count<D>]);
  void check_particles();  ///< throws SimulationError
  std::string describe_unsound(std::int32_t block, std::size_t particle, double strain) const;
  void update_energy_balance() noexcept;
  void accept(State<T, D> next) noexcept;
  material::Sym<double, D> elastic_strain(std::size_t particle) const;  ///< Hencky's
  material::Sym<double, D> stress_by_law(std::size_t particle) const;
  double elastic_volumetric_strain(std::size_t particle) const;  ///< logarithmic
  double plastic_strain(std::size_t particle) const;
  double volume_ratio(std::size_t particle) const;
  double density(std::size_t particle) const;            ///< kg/m3
  double pressure(std::size_t particle) const;           ///< Kirchhoff, Pa, compression positive
  double deviatoric_stress(std::size_t particle) const;  ///< Kirchhoff, Pa, von Mises's
  double preconsolidation_pressure(std::size_t particle) const;  ///< Pa; 0 for elastic snow
  Vec3 velocity(std::size_t particle) const;
  Mat3 affine(std::size_t particle) const;
  std::vector<double> positions() const;  ///< x, y, z of each particle, in the order of storage
  template <class Visit>
  void visit_fields(Visit visit) const;

  const Model<T, D> model_;
  State<T, D> state_;
  Workspace<T, D> workspace_;
  Soundness soundness_;
};

}  // namespace snowshed::methods::mpm
