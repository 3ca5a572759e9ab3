// Settings of the moving particle semi-implicit method in a scene.
#pragma once

namespace snowshed::methods::mps {

/// Laws of the shear stress, see rheology.hpp.
enum class ShearLaw { newtonian, bingham, bingham_dilatant };
/// Form of the yield stress at small shear rates.
enum class Regularisation { papanastasiou, bi_viscous };
/// Shear stress: viscous, with the weighted sum of velocity differences as its force, or elastic
/// until the snow yields, with the divergence of the stress.
enum class Stress { published, elastoplastic };
/// Right-hand side of the pressure equation: Koshizuka and Oka (1996); Tanaka and Masunaga (2010).
enum class Source { published, compensated };
/// Pressure gradient: relative to the least neighbouring pressure, with equal and opposite forces,
/// or exact for linear pressures in any arrangement of the neighbours.
enum class Gradient { published, conservative, corrected };
/// Whether viscosity acts before the pressure or after it.
enum class Splitting { viscosity_first, pressure_first };
/// Steps in which pressure and viscosity are solved together: none, those of stiff creeping fluids,
/// or all. This requires Splitting::pressure_first.
enum class Coupling { none, stiff, always };
/// Where the pressure is zero: at particles of low number density, or half a spacing above them.
enum class Surface { published, mirrored };
/// When particles move: before the pressure is solved, or once at the end of the step.
enum class Order { published, single_move };
/// Rule besides the pressure that keeps particles apart.
enum class SpacingLaw { none, collision, shifting };
/// Representation of walls: images of the particles near them, or particles of their own.
enum class Walls { mirrors, particles };
/// Preconditioner of the pressure equation.
enum class Preconditioner { jacobi, incomplete_cholesky, multigrid };

/// Settings of the moving particle semi-implicit method, with the snow of Saito and others (2012,
/// Annals of Glaciology 53(61)). Their paper does not print the growth coefficient, the dilatant
/// branch and the thresholds of erosion; the values here are ours, see docs/methods/mps.md.
struct Settings {
  double spacing = 0.01;        // m, l0, of particles
  double radius = 2.1;          // r_e over l0
  double max_time_step = 0.01;  // s
  double courant_factor = 0.2;  // longest displacement of a particle in a step, over l0
  double density = 200;         // kg/m3

  ShearLaw rheology = ShearLaw::bingham_dilatant;
  Regularisation regularisation = Regularisation::papanastasiou;
  double viscosity = 0.012;    // Pa s, plastic
  double cohesion = 0;         // Pa, "adhesive force"
  double friction_angle = 24;  // degrees
  double stress_growth = 1e4;  // s, m of Papanastasiou
  double yield_strain = 3e-4;  // shear strain at which elastoplastic snow yields
  double dilatant_rate = 100;  // 1/s, above which the dilatant branch holds
  double dilatant_exponent = 1.5;
  int yield_iterations = 50;  // largest number of iterations for the apparent viscosity, per step

  bool erosion = false;             // whether snow erodes and is deposited
  double erodible_thickness = 0;    // m, of the erodible snow on obstacles at the beginning
  double erosion_pressure = 50;     // Pa
  double erosion_speed = 0.1;       // m/s
  double deposition_pressure = 25;  // Pa
  double deposition_speed = 0.05;   // m/s

  Walls walls = Walls::mirrors;
  Stress stress = Stress::elastoplastic;
  Source source = Source::compensated;
  double compensation = 0.1;  // share of the density's error that a step removes
  Gradient gradient = Gradient::corrected;
  Splitting splitting = Splitting::pressure_first;
  Coupling coupling = Coupling::stiff;
  Surface surface = Surface::mirrored;
  double surface_ratio = 0.97;  // beta, of number densities
  Order order = Order::single_move;
  SpacingLaw spacing_law = SpacingLaw::shifting;
  Preconditioner preconditioner = Preconditioner::multigrid;
  double pressure_tolerance = 1e-4;
  double viscosity_tolerance = 1e-4;
  int max_iterations = 1000;
  int threads = 0;  // 0: all

  /// The smallest length that the method resolves, m.
  double resolution() const { return spacing; }
};

}  // namespace snowshed::methods::mps
