// What a slide is made of: a model that never changes, a state that steps change, and a workspace
// that follows from both and may be thrown away.
#pragma once

#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/methods/slide/areas.hpp"
#include "snowshed/methods/slide/bonds.hpp"
#include "snowshed/methods/slide/cells.hpp"
#include "snowshed/methods/slide/energy.hpp"
#include "snowshed/methods/slide/friction.hpp"
#include "snowshed/methods/slide/grid_fields.hpp"
#include "snowshed/methods/slide/particles.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed {

struct SlideModel {
  SlideModel(const SlideSettings&, double gravity, const HeightField&, SlideAreas,
             bool keeps_energy);

  bool compatible() const { return settings.mode == SlideMode::compatible; }

  SlideSettings settings;
  double gravity;  // m/s2, along -z
  Terrain terrain;
  SlideAreas areas;
  BasalFriction friction;
  std::vector<double> resistance;  // coefficient at each node; empty without such areas
  int threads;
  bool keeps_energy;
};

/// What left the terrain, and the snow it took up on its way.
struct MassBalance {
  double released = 0, entrained = 0, left = 0;  // kg
  std::int64_t particles_left = 0;
};

struct SlideState {
  explicit SlideState(const SlideModel&);

  SlideParticles particles;
  Bonds bonds;
  std::int64_t bonds_made = 0;
  PeakFields peaks;
  std::vector<double> erodible;  // kg/m2 at each node that can still be entrained; may be empty
  MassBalance balance;
  double time = 0, dt = 0;                      // s
  double step;                                  // s, the length of the steps to come
  double kinetic_energy = 0, peak_kinetic = 0;  // J
  bool stopped = false;
  std::uint32_t next_id = 0;
  StepCounters counters;
  SlideEnergy energy;  // its sums over steps
};

/// What acts on a particle during a step.
struct SlideLoad {
  Vec3 acceleration;  // m/s2, by gravity
  Vec3 force;         // N, by the pressure of the snow around and by bonds
  double yield;       // m/s2, deceleration by friction that does not depend on the speed
  double drag;        // 1/m, deceleration over the square of the speed
  double speed;       // m/s, at the beginning of the step
};

/// A particle where it would be at the end of the step without forces.
struct alignas(32) PredictedPoint {
  double x, y, z, thickness;
};

struct SlideWork {
  std::vector<GridPlace> places;    // of the particles
  std::vector<Vec3> normals;        // of the ground there
  AlignedVector<double> thickness;  // m, of the snow there
  CellLists cells;
  AlignedVector<double> entry_z, entry_nz;  // height, and of the normal, in the order of the cells
  GridFields fields;
  BondLists bond_lists;
  std::vector<SlideLoad> loads;
  AlignedVector<PredictedPoint> predicted;
  std::vector<Vec3> bond_forces;
  std::vector<double> entrained;  // kg, by each particle in this step; empty where there is none
  std::vector<char> removed;      // particles that left the terrain
  std::vector<char> broken;       // bonds
  std::vector<std::uint32_t> new_places;
  std::vector<double> piece_sums;
  EnergyAudit audit;

  /// Makes room for all that a step of this state can need, so that nothing fails amid it.
  void make_room(const SlideModel&, SlideState&);
};

/// Iterations that a thread takes at a time.
inline constexpr std::ptrdiff_t particles_in_piece = 256;

/// Makes the workspace follow from the particles: places, cells, fields, bonds.
void refresh(const SlideModel&, const SlideState&, SlideWork&);
/// The same where bonds and the particles' places are known already.
void refresh_fields(const SlideModel&, const SlideState&, SlideWork&);

}  // namespace snowshed
