// The solver for one precision and dimension.
#pragma once

#include "mpm/grid.hpp"
#include "mpm/snow_kind.hpp"
#include "snowshed/mpm/particle_sort.hpp"
#include "snowshed/mpm/sleep.hpp"
#include "snowshed/mpm/solver.hpp"

namespace snowshed {

template <class T, int D>
class SolverOf final : public Solver {
 public:
  SolverOf(const SolverOptions& options, std::vector<Obstacle> obstacles);

  void add(const ParticleBatch&) override;
  void clear() override;
  void kick(const std::vector<Vec3>& velocity_changes) override;
  void settle(const std::vector<double>& drops,
              const std::vector<double>& plastic_changes) override;
  void step() override;
  bool at_safe_point() const override { return !tiles_valid_; }
  std::size_t size() const override { return particles_.size(); }
  double time() const override { return time_; }
  double time_step() const override { return dt_; }
  const StepCounters& counters() const override { return counters_; }
  ParticleState state() const override;
  MotionSummary motion(double speed) const override;
  EnergyBooks energy() const override;
  std::size_t bytes() const override;
  void save(BinaryWriter&) const override;
  void load(const BinaryReader&) override;

 private:
  // The phases of a step.
  void sort();
  void scatter();
  double update_within_limits(double dt);  ///< returns the dt accepted
  void gather_and_update(double dt);
  void update(double dt);
  void update_block(const StepParameters<T>& step, std::ptrdiff_t block);
  void leave_empty(std::ptrdiff_t block);
  double largest_strain();  ///< largest |dt grad v| any particle would take
  void advance(double dt);
  void let_sleep();
  typename Sleep<D>::Look look();
  BlockStats probe(const StepParameters<T>& step, const ParticleView<T>& view, std::int32_t block);
  void clear_idle_nodes();
  void scatter_block(const StepParameters<T>& step, const ParticleView<T>& view,
                     std::ptrdiff_t block);

  StepParameters<T> parameters(double dt) const;
  int threads() const;
  void velocities_around(std::int32_t block, const T* (&velocities)[neighbour_count<D>]);
  void reduce_blocks();
  void check_particles() const;  ///< throws SimulationError
  void book_step();
  double gravitational_energy() const;
  double elastic_energy() const;
  double kinetic_energy() const;
  void find_elastic_limits();
  BlockKey put(std::size_t particle, const VecD<D>& position);  ///< returns the block it is in
  void place(std::vector<BlockKey> blocks);  ///< makes all else follow the particles
  const SnowKind& kind_of(std::size_t particle) const {
    return kinds_[particles_.has_kind ? particles_.kind[particle] : 0];
  }
  std::vector<std::size_t> places_by_id() const;

  SolverOptions options_;
  Kernels<T> kernels_;
  int max_threads_;
  std::vector<SnowKind> kinds_;              // of options_.snows
  std::vector<SnowConstants<T>> constants_;  // the same for the kernels
  double elastic_limit_;                     // s, time step of the stiffest snow there is
  double friction_memory_;                   // s
  Particles<T, D> particles_;
  BlockLayout<D> layout_;
  Contacts<T, D> contacts_;
  Grid<T, D> grid_;
  Sleep<D> sleep_;
  std::vector<double> block_strain_;  // 1/s, of the step being tried

  double time_ = 0, dt_ = 0, speed_ = 0;  // speed: of the fastest particle
  bool tiles_valid_ = false;
  int since_sort_ = 0;
  std::uint32_t next_id_ = 0;
  StepCounters counters_;
  EnergyBooks books_;
  double stress_power_ = 0;  // W, see book_step
};

}  // namespace snowshed
