// Interface between the solver of grains and its kernels: raw views, and a table of functions. The
// kernels are compiled once for each instruction set (cmake/KernelVariants.cmake), so nothing here
// depends on the instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace snowshed::methods::grains {

/// Number of sphere pairs that kernels process at a time. The number of entries of each group is a
/// multiple of it.
inline constexpr std::uint32_t pairs_at_once = 4;

/// Pose and motion of a body: a grain, or a plate, which does not turn.
struct BodyFrame {
  double position[3], velocity[3], spin[3];  // m, m/s, rad/s, in space
  double rotation[9];                        // from its frame to space, by rows
};

/// The sphere pairs of a grain and its partner: another grain (or its image, `shift` periods away),
/// a plate, a wall, the cone.
struct PairGroup {
  std::uint32_t first, second;  // bodies
  std::int32_t shift[2];        // distance of the second's image in x and y, periods
  std::uint32_t begin, end;     // pairs
};

/// Forces of a group's pairs on the two bodies.
struct GroupForce {
  double force[3];                                 // N, on the first
  double torque_on_first[3], torque_on_second[3];  // N m, about their centres
  double heat, broken_energy;                      // J
  std::int32_t touching, tension_breaks, shear_breaks;
};

struct View {
  const BodyFrame* bodies;
  const PairGroup* groups;
  // One value per pair: centres of the spheres in their bodies' frames, m; shear displacement, m;
  // whether there is a bond.
  const double *ax, *ay, *az, *bx, *by, *bz;
  double *ux, *uy, *uz;
  std::uint8_t* bonded;
  GroupForce* results;  // one per group

  double diameter;          // m, of all spheres
  double time_step;         // s
  double period[2];         // m
  double period_growth[2];  // m/s
  double normal_stiffness, shear_stiffness, tension_limit, shear_limit, friction;  // see BondLaw
};

struct Kernels {
  /// Finds the forces of the sphere pairs of a group, and advances their contacts by a time step.
  void (*pair_forces)(const View&, std::size_t group);
};

/// Returns the kernels of the instruction set in use.
const Kernels& chosen_kernels();

}  // namespace snowshed::methods::grains
