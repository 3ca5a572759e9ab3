#include "snowshed/methods/mpm/solver.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"
#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed {
namespace {

/// Memory of the contacts' friction, in elastic time steps of the slowest snow: longer than the
/// vibration of a slab a few cells thick, shorter than the time snow takes to slide over a cell.
constexpr double friction_memory = 40;

/// Whether the particles of a block reach the nodes of the one that sees them as its neighbour k.
template <int D>
bool reaches_into(int reach, int k) {
  for (int d = D - 1; d >= 0; --d, k /= 3) {
    if (k % 3 == 0 && !(reach & above(d))) return false;
    if (k % 3 == 2 && !(reach & below(d))) return false;
  }
  return true;
}

void check_count(const char* what, std::size_t given, std::size_t particles) {
  if (given != particles)
    throw InputError(
        what, std::to_string(given) + " given for " + std::to_string(particles) + " particles");
}

/// Fewer particles than this are not worth waking another thread for, twice a step.
constexpr int particles_per_thread = 2000;

KernelChoice choice_of(const MpmOptions& options) {
  const MpmSettings& n = options.numerics;
  return {options.dimension,        n.transfer,    n.basis, options.snows.front().model,
          options.snows.size() > 1, options.energy};
}

}  // namespace

template <class T, int D>
MpmSolver<T, D>::MpmSolver(const MpmOptions& options, std::vector<Obstacle> obstacles)
    : options_(options),
      kernels_(select_kernels<T>(choice_of(options))),
      max_threads_(options.numerics.threads > 0 ? options.numerics.threads : omp_get_num_procs()),
      contacts_(std::move(obstacles), options.numerics.dx),
      grid_(options.numerics.basis),
      sleep_(options.numerics.sleep_speed, options.numerics.sleep_time, options.gravity) {
  particles_.has_affine = options.numerics.transfer == Transfer::apic;
  particles_.has_material_id = choice_of(options).material_per_particle();
  particles_.has_plastic =
      particles_.has_material_id || options.snows.front().model == SnowModel::cam_clay;
  for (const Snow& snow : options.snows) {
    materials_.emplace_back(snow, D, options.numerics);
    constants_.push_back(material_constants<T>(snow, D));
  }
  find_elastic_limits();
  counters_.smallest_dt = elastic_limit_;
}

/// Of the snows that particles are of; of all while there are none.
template <class T, int D>
void MpmSolver<T, D>::find_elastic_limits() {
  std::vector<bool> present(materials_.size(),
                            !particles_.has_material_id || particles_.size() == 0);
  for (const std::uint8_t material_id : particles_.material_id) present[material_id] = true;
  double shortest = infinity, longest = 0;
  for (std::size_t k = 0; k < materials_.size(); ++k) {
    if (!present[k]) continue;
    shortest = std::min(shortest, materials_[k].elastic_time_step);
    longest = std::max(longest, materials_[k].elastic_time_step);
  }
  elastic_limit_ = shortest;
  friction_memory_ = friction_memory * longest;
}

template <class T, int D>
StepParameters<T> MpmSolver<T, D>::parameters(double dt) const {
  return {T(dt),
          T(options_.numerics.dx),
          T(options_.gravity),
          T(options_.numerics.flip_ratio),
          T(std::min(1.0, dt / friction_memory_)),
          constants_.data()};
}

template <class T, int D>
int MpmSolver<T, D>::threads() const {
  const auto worth = sleep_.awake_particles() / particles_per_thread + 1;
  return int(std::min<std::int64_t>(max_threads_, worth));
}

template <class T, int D>
void MpmSolver<T, D>::add(const ParticleBatch& batch) {
  const std::size_t old = particles_.size();
  const double stored = options_.energy ? energy().stored() : 0.0;
  std::vector<BlockKey> blocks = blocks_of_particles(layout_);
  particles_.resize(old + batch.positions.size());
  particles_.for_each_array([old](const char*, auto& array) {
    using Value = typename std::remove_reference_t<decltype(array)>::value_type;
    std::fill(array.begin() + std::ptrdiff_t(old), array.end(), Value(0));
  });
  const VecD<D> velocity = section<D>(batch.velocity);
  const T plastic = T(materials_.at(std::size_t(batch.material_id)).initial_plastic_strain);
  for (std::size_t i = 0; i < batch.positions.size(); ++i) {
    blocks.push_back(put(old + i, section<D>(batch.positions[i])));
    for (int d = 0; d < D; ++d) particles_.velocity[d][old + i] = T(velocity[d]);
    if (particles_.has_plastic) particles_.plastic[old + i] = plastic;
    particles_.mass[old + i] = T(batch.mass);
    particles_.id[old + i] = next_id_++;
    particles_.event[old + i] = std::uint16_t(batch.event);
    if (particles_.has_material_id)
      particles_.material_id[old + i] = std::uint8_t(batch.material_id);
  }
  find_elastic_limits();
  place(std::move(blocks));
  speed_ = std::max(speed_, velocity.norm());
  if (options_.energy) {
    energy_balance_.gravitational = gravitational_energy();
    energy_balance_.kinetic = kinetic_energy();
    energy_balance_.elastic = elastic_energy();
    energy_balance_.added += energy_balance_.stored() - stored;
  }
}

template <class T, int D>
void MpmSolver<T, D>::check(const std::vector<ParticleBatch>& batches) const {
  for (const ParticleBatch& batch : batches) {
    materials_.at(std::size_t(batch.material_id));
    for (const Vec3& x : batch.positions)
      Placement<D>::of(section<D>(x), options_.numerics.dx, options_.numerics.basis);
  }
}

template <class T, int D>
void MpmSolver<T, D>::add(const std::vector<ParticleBatch>& batches) {
  check(batches);
  for (const ParticleBatch& batch : batches) add(batch);
}

template <class T, int D>
void MpmSolver<T, D>::replace(const std::vector<ParticleBatch>& batches) {
  check(batches);
  clear();
  add(batches);
}

template <class T, int D>
BlockKey MpmSolver<T, D>::put(std::size_t particle, const VecD<D>& position) {
  const auto place = Placement<D>::of(position, options_.numerics.dx, options_.numerics.basis);
  for (int d = 0; d < D; ++d) particles_.cell[d][particle] = T(place.cell[d]);
  return block_key<D>(place.block);
}

template <class T, int D>
void MpmSolver<T, D>::place(std::vector<BlockKey> blocks) {
  sort_particles(particles_, std::move(blocks), layout_, threads());
  contacts_.relocate(layout_.grid_blocks, time_, threads());
  grid_.resize(layout_);
  sleep_.relocate(layout_, time_);
  tiles_valid_ = false;
}

template <class T, int D>
void MpmSolver<T, D>::clear() {
  if (options_.energy) energy_balance_.added -= energy().stored();
  energy_balance_.kinetic = energy_balance_.gravitational = energy_balance_.elastic = 0;
  particles_.resize(0);
  place({});
}

template <class T, int D>
void MpmSolver<T, D>::add_velocity(const std::vector<Vec3>& velocity_changes) {
  const std::vector<std::size_t> at = places_by_id();
  check_count("velocity changes", velocity_changes.size(), at.size());
  for (const Vec3& change : velocity_changes)
    if (!change.allFinite()) throw InputError("velocity changes", "not finite");
  const double before = options_.energy ? kinetic_energy() : 0.0;
  double fastest = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    double v2 = 0;
    const VecD<D> change = section<D>(velocity_changes[k]);
    for (int d = 0; d < D; ++d) {
      T& v = particles_.velocity[d][at[k]];
      v += T(change[d]);
      v2 += double(v) * double(v);
    }
    fastest = std::max(fastest, v2);
  }
  speed_ = std::sqrt(fastest);
  if (options_.energy) {
    energy_balance_.kinetic = kinetic_energy();
    energy_balance_.added += energy_balance_.kinetic - before;
  }
  sleep_.wake_all(layout_, time_);
  tiles_valid_ = false;
}

template <class T, int D>
void MpmSolver<T, D>::settle(const std::vector<double>& drops,
                             const std::vector<double>& plastic_changes) {
  const std::vector<std::size_t> at = places_by_id();
  check_count("drops", drops.size(), at.size());
  check_count("plastic changes", plastic_changes.size(), at.size());
  for (std::size_t k = 0; k < at.size(); ++k)
    if (!std::isfinite(drops[k]) || !std::isfinite(plastic_changes[k]))
      throw InputError("settling", "not finite");
  const double stored = options_.energy ? energy().stored() : 0.0;
  std::vector<BlockKey> blocks = blocks_of_particles(layout_);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const std::size_t i = at[k];
    VecD<D> x =
        position_of(particles_, i, blocks[i], options_.numerics.dx, options_.numerics.basis);
    x[D - 1] -= drops[k];
    blocks[i] = put(i, x);
    if (particles_.has_plastic) particles_.plastic[i] += T(plastic_changes[k]);
  }
  place(std::move(blocks));
  sleep_.wake_all(layout_, time_);
  if (options_.energy) {
    energy_balance_.gravitational = gravitational_energy();
    energy_balance_.added += energy_balance_.stored() - stored;
  }
}

template <class T, int D>
void MpmSolver<T, D>::step() {
  if (particles_.size() == 0) throw SimulationError("there is no snow to simulate");
  if (!tiles_valid_) {
    sort();
    scatter();
  }
  dt_ = update_within_limits(next_time_step(elastic_limit_, speed_, options_.numerics.dx,
                                            options_.numerics.courant_factor));
  g2p2g(dt_);
  time_ += dt_;
  ++counters_.steps;
  counters_.particle_updates += sleep_.awake_particles();
  counters_.slept_updates += std::int64_t(particles_.size()) - sleep_.awake_particles();
  counters_.smallest_dt = std::min(counters_.smallest_dt, dt_);
  if (++since_sort_ >= steps_between_sorts) tiles_valid_ = false;
  check_particles();
  let_sleep();
}

template <class T, int D>
void MpmSolver<T, D>::sort() {
  if (sort_particles(particles_, blocks_of_particles(layout_), layout_, threads())) {
    contacts_.relocate(layout_.grid_blocks, time_, threads());
    grid_.resize(layout_);
  }
  sleep_.relocate(layout_, time_);
  since_sort_ = 0;
  ++counters_.sorts;
}

template <class T, int D>
void MpmSolver<T, D>::scatter() {
  const ParticleView<T> view = particles_.view();
  const StepParameters<T> step = parameters(dt_);
  const std::ptrdiff_t n = std::ptrdiff_t(layout_.particle_blocks.size());
  parallel_for(n, threads(), 1, [&](std::ptrdiff_t b) { scatter_block(step, view, b); });
  clear_idle_nodes();
  tiles_valid_ = true;
}

template <class T, int D>
void MpmSolver<T, D>::scatter_block(const StepParameters<T>& step, const ParticleView<T>& view,
                                    std::ptrdiff_t b) {
  grid_.block_stats[b] = {};
  kernels_.scatter(step, view, layout_.first[b], layout_.first[b + 1] - layout_.first[b],
                   grid_.tile(b), grid_.block_stats[b]);
}

/// First half of a step: the node sums, and at once the node velocities for a step of dt.
template <class T, int D>
void MpmSolver<T, D>::gather_and_update(double dt) {
  contacts_.follow(time_);
  const StepParameters<T> step = parameters(dt);
  const std::vector<std::int32_t>& active = sleep_.active();
  parallel_for(std::ptrdiff_t(active.size()), threads(), 8, [&](std::ptrdiff_t i) {
    const std::int32_t g = active[i];
    contacts_.commit(g);
    const T* tiles[neighbour_count<D>];
    bool touched = false;
    for (int k = 0; k < neighbour_count<D>; ++k) {
      const std::int32_t block = layout_.around_nodes[g][k];
      const bool reaches = block >= 0 && reaches_into<D>(grid_.block_stats[block].reach, k);
      tiles[k] = reaches ? grid_.tile(block) : nullptr;
      touched = touched || reaches;
    }
    grid_.touched[g] = touched;
    if (touched) kernels_.gather(tiles, grid_.sum(g));
    update_block(step, g);
  });
}

template <class T, int D>
void MpmSolver<T, D>::update(double dt) {
  const StepParameters<T> step = parameters(dt);
  const std::vector<std::int32_t>& active = sleep_.active();
  parallel_for(std::ptrdiff_t(active.size()), threads(), 8,
               [&](std::ptrdiff_t i) { update_block(step, active[i]); });
}

template <class T, int D>
void MpmSolver<T, D>::update_block(const StepParameters<T>& step, std::ptrdiff_t g) {
  grid_.node_stats[g] = {};
  if (!grid_.touched[g]) return leave_empty(g);
  kernels_.update(step, grid_.sum(g), grid_.velocity(g), contacts_.of_block(g), contacts_.count(g),
                  contacts_.laws().data(), grid_.node_stats[g]);
}

/// No particle touches these nodes, so nobody asks for their velocities.
template <class T, int D>
void MpmSolver<T, D>::leave_empty(std::ptrdiff_t g) {
  std::fill_n(grid_.node_stats[g].low, D, infinity);
  std::fill_n(grid_.node_stats[g].high, D, -infinity);
  Contact<T>* contacts = contacts_.of_block(g);
  for (int c = 0; c < contacts_.count(g); ++c) contacts[c].next_normal_impulse = 0;
}

/// A step that would strain a particle beyond the limit is not taken: the grid's sums do not
/// depend on dt, so only the node velocities are computed again with a smaller one.
template <class T, int D>
double MpmSolver<T, D>::update_within_limits(double dt) {
  const double limit = options_.numerics.strain_limit;
  gather_and_update(dt);
  while (true) {
    const double strain = largest_strain() * dt;
    if (strain <= limit) return dt;
    ++counters_.rejected;
    dt *= std::min(0.5, 0.8 * limit / strain);
    if (!(dt > 1e-7 * elastic_limit_)) {  // also where the strain is not finite
      std::ostringstream message;
      message << "the time step fell to " << dt << " s at t = " << time_
              << " s: the snow would strain by " << strain << " in one step (limit " << limit
              << "); try a smaller numerics.courant_factor";
      throw SimulationError(message.str());
    }
    update(dt);
  }
}

/// The largest velocity gradient (1/s) the particles will see. B-spline derivatives average nodal
/// differences, so the range of the nodal velocities bounds it: of all nodes, or of those around a
/// block. Only where these bounds are too large are the particles themselves asked.
template <class T, int D>
double MpmSolver<T, D>::largest_strain() {
  const double dx = options_.numerics.dx;
  const double rate_limit =
      options_.numerics.strain_limit /
      next_time_step(elastic_limit_, 0.0, dx, options_.numerics.courant_factor);
  const auto bound_over = [&](const auto& grid_blocks) {
    VecD<D> low = VecD<D>::Constant(infinity), high = -low;
    for (std::int32_t g : grid_blocks) {
      const NodeStats& s = grid_.node_stats[g];
      for (int d = 0; d < D; ++d) {
        low[d] = std::min(low[d], s.low[d]);
        high[d] = std::max(high[d], s.high[d]);
      }
    }
    return std::max(0.0, (high - low).maxCoeff() / dx);  // no snow: negative
  };
  const double overall = bound_over(sleep_.active());
  if (overall <= rate_limit) return overall;

  const StepParameters<T> unit = parameters(1.0);
  const ParticleView<T> view = particles_.view();
  const std::vector<std::int32_t>& awake = sleep_.awake();
  block_strain_.resize(awake.size());
  parallel_for(std::ptrdiff_t(awake.size()), threads(), 64, [&](std::ptrdiff_t i) {
    const std::int32_t b = awake[i];
    double bound = bound_over(layout_.around_particles[b]);
    if (!(bound <= rate_limit)) {
      const double strain = probe(unit, view, b).strain;
      bound = std::isfinite(strain) ? strain : infinity;
    }
    block_strain_[i] = bound;
  });
  return *std::max_element(block_strain_.begin(), block_strain_.end());
}

template <class T, int D>
void MpmSolver<T, D>::velocities_around(std::int32_t b,
                                        const T* (&velocities)[neighbour_count<D>]) {
  for (int k = 0; k < neighbour_count<D>; ++k)
    velocities[k] = grid_.velocity(layout_.around_particles[b][k]);
}

template <class T, int D>
void MpmSolver<T, D>::g2p2g(double dt) {
  const StepParameters<T> step = parameters(dt);
  const ParticleView<T> view = particles_.view();
  const std::vector<std::int32_t>& awake = sleep_.awake();
  parallel_for(std::ptrdiff_t(awake.size()), threads(), 1, [&](std::ptrdiff_t i) {
    const std::int32_t b = awake[i];
    const T* velocities[neighbour_count<D>];
    velocities_around(b, velocities);
    grid_.block_stats[b] = {};
    kernels_.g2p2g(step, view, layout_.first[b], layout_.first[b + 1] - layout_.first[b],
                   velocities, grid_.tile(b), grid_.block_stats[b]);
  });
  reduce_blocks();
}

template <class T, int D>
void MpmSolver<T, D>::reduce_blocks() {
  double speed_squared = 0;
  for (std::int32_t b : sleep_.awake()) {
    const BlockStats& s = grid_.block_stats[b];
    speed_squared = std::max(speed_squared, s.speed_squared);
    if (s.escaped) tiles_valid_ = false;
  }
  speed_ = std::sqrt(speed_squared);
  if (options_.energy) update_energy_balance();
}

/// The step is done and its state is whole; the next one might not be.
template <class T, int D>
void MpmSolver<T, D>::check_particles() const {
  for (std::int32_t b : sleep_.awake()) {
    const BlockStats& s = grid_.block_stats[b];
    if (s.unsound < 0) continue;
    const std::size_t i = std::size_t(s.unsound);
    const VecD<D> x = position_of(particles_, i, layout_.particle_blocks[b], options_.numerics.dx,
                                  options_.numerics.basis);
    std::ostringstream message;
    message << "particle " << particles_.id[i] << " at (" << x[0];
    for (int d = 1; d < D; ++d) message << ", " << x[d];
    message << ") m, t = " << time_ << " s: ";
    if (std::isfinite(s.elastic_strain))
      message << "its elastic strain has come to " << s.elastic_strain
              << ", beyond what can be resolved (" << elastic_strain_limit
              << "); snow.youngs_modulus is too small for such speeds";
    else
      message << "its state is no longer finite; try a smaller numerics.courant_factor or double "
                 "precision";
    throw SimulationError(message.str());
  }
}

template <class T, int D>
BlockStats MpmSolver<T, D>::probe(const StepParameters<T>& step, const ParticleView<T>& view,
                                  std::int32_t b) {
  const T* velocities[neighbour_count<D>];
  velocities_around(b, velocities);
  BlockStats stats;
  kernels_.probe(step, view, layout_.first[b], layout_.first[b + 1] - layout_.first[b], velocities,
                 stats);
  return stats;
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

std::unique_ptr<Method> make_mpm(const MpmOptions& options, std::vector<Obstacle> obstacles) {
  const bool single = options.numerics.precision == Precision::float32;
  if (options.dimension == 2) {
    if (single) return std::make_unique<MpmSolver<float, 2>>(options, std::move(obstacles));
    return std::make_unique<MpmSolver<double, 2>>(options, std::move(obstacles));
  }
  if (single) return std::make_unique<MpmSolver<float, 3>>(options, std::move(obstacles));
  return std::make_unique<MpmSolver<double, 3>>(options, std::move(obstacles));
}

}  // namespace snowshed
