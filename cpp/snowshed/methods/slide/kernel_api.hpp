// Interface between the slide's solver and its kernels: raw views, and a table of functions. The
// kernels are compiled once for each instruction set (cmake/KernelVariants.cmake), so nothing here
// depends on the instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace snowshed::methods::slide {

/// Effect of friction within a step.
enum class FrictionScheme {
  set_valued,         // Coulomb friction stops and holds snow
  avaframe_implicit,  // a rate that divides by the earlier speed
  avaframe_explicit
};

/// Correction of the pressure for few neighbours. With n neighbours in the kernel the pressure is
/// multiplied by 1 + factor n^-power, at most by 2. In a triangular lattice with N particles within
/// the kernel the sum gives n = N - 5 N^-0.4, within a few percent for N above 10. The factor is N
/// / n within 2 %.
struct FewNeighbours {
  double factor, power;
};
inline constexpr FewNeighbours few_neighbours{3.7, 1.32};

/// Minimum thickness in divisors, m.
inline constexpr double min_thickness = 1e-6;

/// Number of entries that may be read after those of the sorted arrays; their values are not used.
inline constexpr std::size_t sorted_padding = 8;

/// Arrays with one value for each particle, and constants.
struct View {
  // The ground: records of height, slopes along x and y, and area at the nodes, row by row.
  const double* ground;
  int columns, rows;
  double cell, per_cell;  // m, 1/m

  // The snow on the nodes of a rectangle: records of thickness and velocity, row by row.
  const double* flow;
  int flow_column, flow_row, flow_columns;  // the first node, on the grid of the ground

  // The same records while they are computed in place: first the sums of mass and momentum, then
  // thickness and velocity.
  double* nodes;
  // Default mode: a copy of the sums for mean_speed.hpp; otherwise null.
  double* sums;
  // Peaks at the nodes of the terrain that the snow raises, or null.
  double *peak_thickness, *peak_speed;
  double fading_mass;  // kg, below which the mean speed there fades

  // Particles.
  double *x, *y, *z, *ux, *uy, *uz;
  const double* mass;

  // Cells and positions within these, normals of the ground, thickness of the snow.
  std::int32_t *column, *row;
  double *east, *north;
  double *nx, *ny, *nz;
  double* thickness;

  // Accelerations by the loads.
  double *ax, *ay, *az;          // m/s2
  double* coulomb_deceleration;  // m/s2, deceleration by friction that does not depend on the speed
  double* drag;                  // 1/m, deceleration over the square of the speed
  double* speed;                 // m/s, at the beginning of the step
  double* predicted;  // records of x, y, z at the end of the step without forces, and thickness
  double* pressure_force;  // records of force by the snow's pressure (N) and 0
  char* removed;           // set for particles that left the terrain

  // Particles in the order of their cells; in the default mode with z and the factor on the
  // pressure.
  double *sorted_x, *sorted_y, *sorted_z, *sorted_mass;
  double *sorted_pressure_factor, *sorted_column_mass;  // the mass times f of columns.hpp, kg
  const std::uint32_t* sorted_particle;
  const std::uint32_t* cell_begin;  // entries of the cells of a rectangle with a margin, row by row
  int cell_columns, cell_rows;

  // Bonds, and for each particle its bonds, coded as 2 · bond + (1 if the particle is its second).
  // Null without bonds.
  const std::uint32_t *bond_first, *bond_second;
  const double* rest_length;
  char* broken;
  double* bond_force;  // records of force (N) on the first particle and 0
  const std::uint32_t *bond_begin, *bond_entry;

  double time_step, gravity, density;  // s, m/s2, kg/m3
  double friction, friction_drag;      // see BasalFriction
  double viscosity;                    // artificial; compatible mode
  double mixed_share;  // default mode: share of the mean velocity that a step takes over
  bool across_flow;    // whether columns are normal to the flow, not vertical
  double max_strain, bond_modulus, min_bond_length;
  FrictionScheme scheme;
  double added_speed;  // m/s; AvaFrame adds it where it divides by a speed
};

/// Each kernel processes a range of particles or bonds, or a row; several of these may run at the
/// same time.
struct Kernels {
  /// Computes the cell positions of the particles, which must be on the terrain, and the normals at
  /// them.
  void (*locate)(const View&, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Mixes velocities with those of the snow around and finds the forces of the ground.
  void (*ground)(const View&, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Default mode: finds the factor on the pressure and the mass of the columns for the particles
  /// of a row of cells.
  void (*weigh_pressure)(const View&, int row);
  /// Finds the force by the snow's pressure on the particles of a row of cells: along the ground,
  /// or along the map as AvaFrame does it.
  void (*surface_pressure)(const View&, int row);
  void (*map_pressure)(const View&, int row);
  /// Finds the forces of bonds; returns whether one breaks.
  bool (*stretch_bonds)(const View&, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Moves the particles by the forces on them; returns their kinetic energy, J.
  double (*advance)(const View&, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Sums mass and momentum of the particles of a row of cells on the nodes, and copies the values
  /// that their neighbours will read. The odd rows follow when all even ones are done; they turn
  /// the sums into thickness and velocity, and raise the peaks.
  void (*sum_on_nodes)(const View&, int row);
  /// Default mode: raises the peak speed along a row of nodes, from two rows before the rectangle
  /// to two rows after it, when all sums are done.
  void (*raise_mean_speed)(const View&, int row);
  /// Finds the thickness of the snow at the particles.
  void (*thickness)(const View&, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Finds the smallest and the largest of at least one number.
  void (*bounds)(const std::int32_t* values, std::ptrdiff_t count, std::int32_t& low,
                 std::int32_t& high);
};

/// Returns the kernels of the instruction set in use.
const Kernels& chosen_kernels();

}  // namespace snowshed::methods::slide
