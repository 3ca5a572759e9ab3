// Parts of a simulation of grains: a model that never changes, a state that steps change, and a
// workspace that may be thrown away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/grains/bond_law.hpp"
#include "snowshed/methods/grains/boundary.hpp"
#include "snowshed/methods/grains/energy.hpp"
#include "snowshed/methods/grains/loading_progress.hpp"
#include "snowshed/methods/grains/pair_list.hpp"
#include "snowshed/methods/grains/rotor.hpp"
#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::methods::grains {

/// Motion of a grain, and the forces on it.
struct GrainBody {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();  // m, m/s, of the centre of mass
  Orientation orientation{1, 0, 0, 0};
  Vec3 spin_momentum = Vec3::Zero();                         // kg m2/s, about the centre, in space
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();          // N, N m; damped
  Vec3 damping = Vec3::Zero(), spin_damping = Vec3::Zero();  // N, N m; part of the above
};

/// Constants of a grain.
struct GrainConstants {
  double volume, inertial_mass, weight;  // m3; kg, scaled; N, downward
  Vec3 inertia;                          // kg m2, principal, scaled
  double reach;                          // m, distance of the farthest sphere's centre
  Vec3 initial_position;
  Orientation initial_orientation;
  std::uint32_t first_sphere, spheres;
};

/// Minimum number of pairs per thread.
inline constexpr std::size_t pairs_per_thread = 512;

struct Model {
  explicit Model(Options);

  Settings settings;
  double gravity;  // m/s2, along -z
  std::vector<LoadingStage> loading;
  Cone cone;
  bool keeps_energy;
  int threads;
  double radius;  // m, of all spheres
  Vec3 box;       // m
  std::vector<GrainConstants> grains;
  SphereBodies spheres;
  std::vector<BondedPair> bonds;
  BondLaw law;
  double solid_volume;  // m3

  /// Threads for steps with this number of pairs: a thread with little work costs more time than it
  /// saves.
  int threads_for(std::size_t pairs) const {
    return snowshed::threads_for(pairs, pairs_per_thread, threads);
  }
  double area() const { return box.x() * box.y(); }
  LoadedSample loaded_sample() const { return {box, radius, law.normal_stiffness}; }
  bool periodic() const { return settings.sides == Sides::periodic; }
};

struct State {
  std::vector<GrainBody> bodies;  // empty before the grains are added
  std::vector<std::uint16_t> events;
  std::uint32_t first_id = 0, next_id = 0;
  Boundary boundary;
  LoadingProgress loading;
  PairList pairs;
  std::vector<GrainPose> searched_poses;  // poses of the grains at the last search for pairs
  Boundary searched_boundary;
  double time = 0, dt = 0;  // s
  std::int64_t bonds = 0, broken_in_tension = 0, broken_in_shear = 0;
  StepCounters counters;
  std::int64_t pair_searches = 0;
  EnergyBalance energy;  // sums over steps; stored energies are computed on request
};

struct Workspace {
  std::vector<GrainBody> next;        // grains at the end of a step
  std::vector<BodyFrame> frames;      // one per grain and plate
  std::vector<GroupForce> results;    // one per group of pairs
  BodyGroups groups_by_body;          // groups of each grain
  double max_step = 0;                // s, largest that all listed pairs allow
  std::vector<double> damped_energy;  // J, lost by each grain in a step
};

}  // namespace snowshed::methods::grains
