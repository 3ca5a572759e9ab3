// Parts of a slide: a model that never changes, a state that steps change, and a workspace that
// follows from both and may be thrown away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/core/thread_choice.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/bonds.hpp"
#include "snowshed/methods/slide/cells.hpp"
#include "snowshed/methods/slide/changing_ground.hpp"
#include "snowshed/methods/slide/energy.hpp"
#include "snowshed/methods/slide/friction.hpp"
#include "snowshed/methods/slide/grid_fields.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"
#include "snowshed/methods/slide/late_release.hpp"
#include "snowshed/methods/slide/particles.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

/// Minimum number of particles per thread.
inline constexpr std::size_t particles_per_thread = 400;
/// For steps with fewer particles a trial decides whether threads make them faster.
inline constexpr std::size_t particles_for_threads = 20000;

/// Marks of particles that a step removes: in `Workspace::removed`. Kernels set the first one.
inline constexpr char left_terrain = 1, became_ground = 2;

struct Model {
  Model(const Settings&, double gravity, const geometry::HeightField&, Areas, bool keeps_energy);

  bool detrains() const { return settings.detrainment > 0 && !areas.resistance.empty(); }
  /// Whether bonds weaken with the mass that forest takes.
  bool thins_bonds() const { return detrains() && !compatible(); }
  bool compatible() const { return settings.mode == Mode::compatible; }
  /// Whether the positions before a step are needed at its end.
  bool keeps_positions() const {
    return !dams.empty() || (compatible() && settings.ground_gains_stopped);
  }
  /// Maximum number of threads for a step of this number of particles.
  int threads_for(std::size_t particles) const {
    return snowshed::threads_for(particles, particles_per_thread, threads);
  }

  Settings settings;
  double gravity;  // m/s2, along -z
  Terrain terrain;
  Areas areas;
  BasalFriction friction;
  std::vector<double> resistance;  // coefficient at each node; empty without areas
  DamFeet dams;
  int threads;
  bool keeps_energy;
  std::vector<LateRelease> late;  // made after the areas have been checked
};

/// Masses of the snow that came and went. `released` is the snow at the start; `secondary` and
/// `inflow` came later.
struct MassBalance {
  double released = 0, secondary = 0, inflow = 0, entrained = 0;  // kg
  double detrained = 0, left_terrain = 0;                         // kg
  double stopped = 0;                                             // kg, that became ground
  std::int64_t particles_left = 0;
};

struct State {
  explicit State(const Model&);

  Particles particles;
  Bonds bonds;
  std::int64_t bonds_made = 0;
  PeakFields peaks;
  std::vector<double> late;       // for each late release: waiting, due, or its time, s
  std::vector<double> over_dams;  // kg that passed each dam
  // Whether forest stands at each node; empty without detrainment, when forest is never destroyed.
  std::vector<std::uint8_t> forest;
  std::vector<double> erodible;          // kg/m2 of snow left to entrain at each node; may be empty
  std::optional<ChangingGround> ground;  // none if the ground does not change
  std::int64_t bonds_in_ground = 0;      // number, of snow that became ground
  MassBalance balance;
  double time = 0, dt = 0;                      // s
  double step;                                  // s, the length of the steps to come
  double kinetic_energy = 0, peak_kinetic = 0;  // J
  bool stopped = false;
  std::uint32_t next_id = 0;
  StepCounters counters;
  std::int64_t sorts = 0;  // by cells
  EnergyBalance energy;    // sums over steps; stored energies are computed on request
};

/// Positions of the particles in the cells of the grid, and the normals of the ground at them.
struct CellPositions {
  AlignedVector<std::int32_t> column, row;
  AlignedVector<double> east, north;  // within the cell, 0 to 1
  AlignedVector<double> nx, ny, nz;

  std::size_t size() const { return column.size(); }
  geometry::CellPosition at(std::size_t i) const { return {column[i], row[i], east[i], north[i]}; }
  Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }

  template <class Self, class Visit>
  static void for_each_array(Self& self, const Visit& visit) {
    visit(self.column);
    visit(self.row);
    visit(self.east);
    visit(self.north);
    visit(self.nx);
    visit(self.ny);
    visit(self.nz);
  }
  void resize(std::size_t n) {
    for_each_array(*this, [n](auto& array) { array.resize(n); });
  }
};

/// Loads on each particle during a step; see View.
struct Loads {
  AlignedVector<double> ax, ay, az, coulomb_deceleration, drag, speed;

  void resize(std::size_t n) {
    for (auto* array : {&ax, &ay, &az, &coulomb_deceleration, &drag, &speed}) array->resize(n);
  }
};

struct Workspace {
  CellPositions cell_positions;
  AlignedVector<double> thickness;  // m, of the snow at the particles
  CellLists cells;
  // In the order of the cells, see View.
  AlignedVector<double> sorted_pressure_factor, sorted_column_mass;
  GridFields fields;
  BondLists bond_lists;
  Loads loads;
  AlignedVector<double> predicted;       // records of four for each particle, see View
  AlignedVector<double> pressure_force;  // records of four for each particle
  AlignedVector<double> bond_force;      // records of four for each bond
  std::vector<double> entrained;  // kg, by each particle in this step; empty without entrainment
  std::vector<double> detrained;  // kg, from each particle in this step; empty without detrainment
  std::vector<char> removed;      // marks of particles that left the terrain or became ground
  std::vector<char> gone;         // particles of which forest took all; empty without detrainment
  std::vector<Vec3> positions_before;  // m, before the step; empty if they are not needed
  StepChanges step_changes;            // compatible mode, if the ground changes
  std::vector<DamCrossing> passed_dams;
  std::vector<char> broken;  // bonds that break in this step
  bool bonds_break = false;  // whether any bond breaks in this step
  std::vector<std::uint32_t> new_indices;
  std::vector<double> piece_sums;
  bool no_particle_splits = false;  // no particle is too heavy, and none becomes heavier
  EnergyRecorder energy_recorder;
  int threads = 1;  // threads that share the loops
  ThreadChoice thread_choice;

  /// Reserves all memory that a step of this state can need, so that a step cannot fail half-way.
  void reserve_memory(const Model&, State&);
};

/// Number of particles or bonds that a thread processes at a time.
inline constexpr std::ptrdiff_t particles_in_piece = 64;

/// The kernels' view of a slide, valid until an array of it changes its size.
View view_of(const Model&, State&, Workspace&);

/// Calls f(begin, end) for the pieces of `count` particles or bonds.
template <class F>
void for_each_piece(const Workspace& work, std::size_t count, F f) {
  parallel_pieces(std::ptrdiff_t(count), work.threads, particles_in_piece, f);
}

/// Updates the workspace from the particles: cell positions, cells, fields, bonds. Raises the given
/// peaks to the values of the fields.
void refresh(const Model&, const State&, Workspace&, PeakFields* raised = nullptr);
/// Updates the cell positions of the particles [begin, end), for which the workspace must have
/// memory.
void refresh_cell_positions(const Model&, const State&, Workspace&, std::size_t begin,
                            std::size_t end);
/// Does the rest of `refresh` if bonds and the particles' cell positions are up to date.
void refresh_fields(const Model&, const State&, Workspace&, PeakFields* raised);

}  // namespace snowshed::methods::slide
