// The solver for one precision and dimension.
#pragma once

#include "snowshed/methods/mpm/boundary.hpp"
#include "snowshed/methods/mpm/grid.hpp"
#include "snowshed/methods/mpm/material_constants.hpp"
#include "snowshed/methods/mpm/particle_sort.hpp"
#include "snowshed/methods/mpm/sleep.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed {

template <class T, int D>
class MpmSolver final : public Method {
 public:
  MpmSolver(const MpmOptions& options, std::vector<Obstacle> obstacles);

  void add(const ParticleBatch&) override;
  void add(const std::vector<ParticleBatch>&) override;
  void replace(const std::vector<ParticleBatch>&) override;
  void clear() override;
  void add_velocity(const std::vector<Vec3>& velocity_changes) override;
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
  EnergyBalance energy() const override;
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
  void g2p2g(double dt);
  void let_sleep();
  typename Sleep<D>::BlockProbe block_probe();
  BlockStats probe(const StepParameters<T>& step, const ParticleView<T>& view, std::int32_t block);
  void clear_idle_nodes();
  void scatter_block(const StepParameters<T>& step, const ParticleView<T>& view,
                     std::ptrdiff_t block);

  StepParameters<T> parameters(double dt) const;
  int threads() const;
  void velocities_around(std::int32_t block, const T* (&velocities)[neighbour_count<D>]);
  void reduce_blocks();
  void check_particles() const;  ///< throws SimulationError
  void update_energy_balance();
  double gravitational_energy() const;
  double elastic_energy() const;
  double kinetic_energy() const;
  void find_elastic_limits();
  void check(const std::vector<ParticleBatch>&) const;          ///< throws where `add` would
  BlockKey put(std::size_t particle, const VecD<D>& position);  ///< returns the block it is in
  void place(std::vector<BlockKey> blocks);  ///< makes all else follow the particles
  const Material& material_of(std::size_t particle) const {
    return materials_[particles_.has_material_id ? particles_.material_id[particle] : 0];
  }
  std::vector<std::size_t> places_by_id() const;

  MpmOptions options_;
  Kernels<T> kernels_;
  int max_threads_;
  std::vector<Material> materials_;              // of options_.snows
  std::vector<MaterialConstants<T>> constants_;  // the same for the kernels
  double elastic_limit_;                         // s, time step of the stiffest snow there is
  double friction_memory_;                       // s
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
  EnergyBalance energy_balance_;
  double stress_power_ = 0;  // W, see book_step
};

}  // namespace snowshed
