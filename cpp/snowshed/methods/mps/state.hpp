// Parts of the MPS method: a model that never changes, a state that steps change, and a workspace
// that follows from both and may be thrown away.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/mps/boundary.hpp"
#include "snowshed/methods/mps/conjugate_gradients.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"
#include "snowshed/methods/mps/multigrid.hpp"
#include "snowshed/methods/mps/particles.hpp"
#include "snowshed/methods/mps/rheology.hpp"
#include "snowshed/methods/mps/solver.hpp"
#include "snowshed/methods/mps/wall_images.hpp"
#include "snowshed/methods/mps/wall_particles.hpp"
#include "snowshed/methods/obstacle_forces.hpp"
#include "snowshed/particles/neighbour_lists.hpp"

namespace snowshed::methods::mps {

/// Minimum number of particles per thread: a thread with little work costs more than it saves.
inline constexpr std::size_t particles_per_thread = 500;

template <int D>
struct Model {
  explicit Model(Options);

  const Settings& settings() const { return options.settings; }
  double reach() const { return settings().spacing * settings().radius; }
  /// 2 d/(lambda n0), 1/m2: turns a sum of weighted differences into a Laplacian, equation (5).
  double laplacian() const {
    return 2 * D / (kernel.lambda * kernel.number_density) /
           (settings().spacing * settings().spacing);
  }
  /// d/n0: turns a sum over neighbours into a gradient, equation (4).
  double gradient() const { return D / kernel.number_density; }
  double particle_mass() const { return settings().density * std::pow(settings().spacing, D); }

  Options options;
  VecD<D> gravity;  // m/s2
  KernelConstants kernel;
  double second_layer;        // see second_layer_share
  double surface_deficit;     // see second_layer_deficit
  double surface_difference;  // see the function of this name
  Rheology rheology;
  const Kernels<D>& kernels = chosen_kernels<D>();
  int threads;

  bool has_wall_particles() const { return settings().walls == Walls::particles; }
  /// A fluid without a yield stress has no elastic strain.
  bool is_elastic() const {
    return settings().stress == Stress::elastoplastic && !rheology.is_newtonian();
  }
  /// See Rheology::yield_rate, 1/s.
  double yield_rate(double yield, double dt) const {
    return rheology.yield_rate(yield, settings().yield_strain, dt);
  }
  bool is_sticky(const WallContact<D>& c) const {
    return options.obstacles[c.obstacle].law.condition == Condition::sticky;
  }

  /// Threads for a step of this number of particles.
  int threads_for(std::size_t particles) const {
    return snowshed::threads_for(particles, particles_per_thread, threads);
  }
};

/// Quality of the solutions of a step's equations.
struct Solves {
  SolveReport pressure, viscosity;
};

template <int D>
struct State {
  Particles<D> particles;
  double time = 0, dt = 0;  // s
  std::uint32_t next_id = 0;
  StepCounters counters;
  EnergyBalance energy;  // sums over steps; stored energies are computed on request
  Solves solves;         // solves of the last step
  std::int64_t pressure_iterations = 0, viscosity_iterations = 0;  // sums over all steps
};

/// Geometry of the particles at their present positions, found in each step.
template <int D>
struct Neighbourhood {
  particles::CellOrder<D> cells;
  particles::NeighbourLists<D> lists;
  RowLists<WallContact<D>> contacts;
  WallImages<D> images;
  // One value per pair of particles, in the order of the lists.
  AlignedVector<float> weight;      // w(r)
  AlignedVector<float> coupling;    // the sum of w over the neighbour and its images behind walls
  AlignedVector<float> slope;       // w(r)/r^2, 1/m2
  AlignedVector<float> snow_slope;  // the same, 0 if the neighbour is a wall particle
  AlignedVector<float> isotropic_weight;  // w(r), corrected for both second moments, for viscosity

  // One value per particle, summed over its pairs.
  AlignedVector<float> weight_sum;       // sum of w(r)
  AlignedVector<float> filling_sum;      // sum of filling_weight(r)
  AlignedVector<RowMoments<D>> moments;  // moments of w(r)
  AlignedVector<double> density;         // number density
  AlignedVector<double> filling;         // the filling over that of a lattice
  AlignedVector<VecD<D>> asymmetry;      // sum of w(r) r, m; 0 near the surface, and at dummies
  // Correction of gradients, see find_corrections.
  AlignedVector<Eigen::Matrix<double, D, D>> correction;
  AlignedVector<std::array<float, RowMoments<D>::half>> weight_correction;  // upper half of B

  AlignedVector<double> open_moment;  // m, see find_open_moments

  // Classes of particles, and wall velocities.
  AlignedVector<std::uint8_t> surface;         // at the free surface
  AlignedVector<std::uint8_t> below_surface;   // at the free surface or next to it
  AlignedVector<std::uint8_t> dry;             // inner wall above the surface of the snow
  AlignedVector<VecD<D>> divergence_velocity;  // m/s; inner walls move as the snow around them

  /// A particle's contact with an obstacle, or null.
  const WallContact<D>* contact_with(std::size_t i, std::uint32_t obstacle) const {
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c)
      if (c->obstacle == obstacle) return c;
    return nullptr;
  }
  VecD<D> separation(std::size_t entry) const { return lists.separation(entry); }
  PairRows rows() const { return {lists.first(), lists.index()}; }
  std::array<const float*, D> offsets() const {
    std::array<const float*, D> axes;
    for (int d = 0; d < D; ++d) axes[std::size_t(d)] = lists.offset(d);
    return axes;
  }
  const WallContact<D>& wall(const WallImage<D>& image, int k) const {
    return contacts.all()[image.contact[k]];
  }
};

/// The equation of the pressure, one value per particle.
template <int D>
struct PressureSolve {
  AlignedVector<double> diagonal, source, values;  // matrix, right-hand side and solution (Pa)
  AlignedVector<std::uint8_t> fixed;               // whether the pressure is given
  bool enclosed = false;                           // whether there is no free surface
  double scale = 0;                                // norm of the right-hand side
  AlignedVector<double> base;                      // Pa, see find_base_pressures
  AlignedVector<VecD<D>> sum;                      // weighted sum of pressures, see sum_pressures
  Multigrid<D, 1> multigrid;
};

/// Velocity gradients and shear rates, from which the apparent viscosities follow.
template <int D>
struct ShearRates {
  AlignedVector<Eigen::Matrix<double, D, D>> gradient;    // velocity gradients, 1/s
  AlignedVector<Eigen::Matrix<double, D, D>> correction;  // correction of velocity gradients
  const float* snow_slope = nullptr;                      // slopes of pairs, 0 for walls
  AlignedVector<Eigen::Matrix<double, D, D>> elastic;     // elastic strains over the step, 1/s
  AlignedVector<float> pair_rate;                         // 1/s, midway between a pair
  AlignedVector<double> smooth_pressure;                  // Pa
};

/// The equation of the velocities after a step with viscosity.
template <int D>
struct ViscousSolve {
  AlignedVector<VecD<D>> right_side, residual;  // m/s
  AlignedVector<float> coupling;                // coupling of velocities, one per pair
  AlignedVector<float> weight;                  // weights of pairs, see find_stress_weights
  AlignedVector<Eigen::Matrix<double, D, D>> block, inverse_block;
  AlignedVector<Eigen::Matrix<double, D, D>> own_block;  // without the couplings
  // See kernels/stress.hpp; vectors of pairs have their components one after the other.
  AlignedVector<float> lever, far_lever;
  AlignedVector<VecD<D>> lever_sum;
  AlignedVector<std::array<double, D*(D - 1) / 2>> turn, torque;
  AlignedVector<double> diagonal;
  Multigrid<D, D> multigrid;  // built if needed
};

/// Viscous forces that the pressure of a step takes into account.
template <int D>
struct SplitForces {
  AlignedVector<VecD<D>> predicted_velocity;             // with gravity alone, m/s
  AlignedVector<VecD<D>> expected_viscous_acceleration;  // m/s2
  AlignedVector<VecD<D>> viscous_acceleration;           // m/s2, of the last iteration
  AlignedVector<std::uint8_t> flowing;                   // whether a viscous force is expected
};

/// Friction of walls on the particles beside them.
struct WallFriction {
  AlignedVector<double> share, weight_sum;  // see compute_wall_contact_fractions
  AlignedVector<double> drag;               // one per contact with a wall, 1/s
  AlignedVector<double> yield_slip;         // one per contact, largest elastic slip, m
  AlignedVector<double> reaction;           // see find_wall_reactions, Pa
};

/// Corrections of the distances between particles.
template <int D>
struct SpacingCorrection {
  AlignedVector<double> impulse_share;   // share of a collision that the other particle takes
  AlignedVector<VecD<D>> concentration;  // gradient of the concentration, 1/m, for shifting
};

/// Impulses of the snow on the walls in a step, N s.
struct WallImpulses {
  std::vector<ContactImpulse> by_name;
  std::vector<std::pair<std::int32_t, double>> pushes;  // patch of the pressure map, impulse
  double moving_mass = 0;                               // kg
  Vec3 momentum = Vec3::Zero();                         // kg m/s, before the step
};

template <int D>
struct Workspace {
  WallParticles<D> walls;  // if the settings ask for them
  State<D> next, start;    // the step's result, and its beginning with the present walls
  Particles<D> spare;
  Neighbourhood<D> near;
  AlignedVector<VecD<D>> before;        // velocities at the beginning of the step, m/s
  AlignedVector<VecD<D>> change;        // change of velocities or positions by a part of the step
  AlignedVector<std::uint8_t> changed;  // whether a particle is eroded or deposited
  SplitForces<D> splitting;
  PressureSolve<D> pressure;
  ViscousSolve<D> viscosity;
  ShearRates<D> rates;
  WallFriction wall_friction;
  SpacingCorrection<D> spacing;
  // If forces are recorded, one per contact: impulse on the wall by its drag (N s), and speed with
  // which the wall pushed the particle out (m/s).
  AlignedVector<VecD<D>> wall_impulse;
  AlignedVector<double> wall_stop;
  WallImpulses wall_impulses;
  bool records_forces = false;
  CgWorkspace cg;  // shared by both solves
};

inline constexpr std::ptrdiff_t particles_in_piece = 256;

/// f(begin, end) for all particles, in pieces.
template <class F>
void for_each_piece(std::size_t count, int threads, F f) {
  parallel_pieces(std::ptrdiff_t(count), threads, particles_in_piece, f);
}
/// f(i) for all particles, in pieces.
template <class F>
void for_each_particle(std::size_t count, int threads, F f) {
  for_each_piece(count, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) f(std::size_t(i));
  });
}

}  // namespace snowshed::methods::mps
