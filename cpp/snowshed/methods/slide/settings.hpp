// Settings of the snow slide in a scene.
#pragma once

namespace snowshed::methods::slide {

/// `improved` mends the known faults of com5SnowSlide; `compatible` follows AvaFrame 2.1.
enum class Mode { improved, compatible };

/// Laws of friction between snow and ground, see friction.hpp.
enum class FrictionLaw { voellmy, coulomb };

/// Directions of the snow's columns, along which its weight presses on the ground (improved mode).
enum class Columns { vertical, across_flow };

/// Settings of the snow slide: depth-averaged particles with cohesive bonds. The defaults are those
/// of AvaFrame's com5SnowSlide.
struct Settings {
  Mode mode = Mode::improved;
  double cell = 0;                // m, of the computing grid; 0: that of the terrain
  double time_step = 0.01;        // s
  double density = 300;           // kg/m3, of the snow that slides
  double layer_thickness = 0.25;  // m, thickness of snow that makes one particle in a cell

  FrictionLaw friction_law = FrictionLaw::voellmy;
  double friction = 0.325;         // Coulomb coefficient mu
  double turbulence = 58;          // m/s2, Voellmy's xi
  bool explicit_friction = false;  // compatible mode only
  double resistance = 30000;       // drag coefficient within the resistance areas
  double detrainment = 0;          // Pa, Feistl's K within the resistance areas; 0: none
  // With detrainment, forest stops slower or thinner snow than the minima, resists snow between
  // them, and is destroyed by snow above the maxima.
  double forest_min_speed = 6;        // m/s
  double forest_min_thickness = 0.6;  // m
  double forest_max_speed = 40;       // m/s
  double forest_max_thickness = 10;   // m
  // Ground that adapts to the snow.
  bool ground_gains_stopped = false;    // rises where snow has stopped
  bool ground_gains_detrained = false;  // rises where forest takes snow
  bool ground_loses_entrained = false;  // falls where snow is eroded
  double ground_min_change = 0.1;       // m, of one node, at which the ground changes
  double ground_rest_time = 1;          // s, after which resting snow is ground; improved mode only
  double artificial_viscosity = 100;    // compatible mode only
  // Improved mode only.
  Columns columns = Columns::vertical;
  double mixing_rate = 8;  // 1/s, at which particles take over the mean velocity around them

  bool bonds = true;
  double max_strain = 0.2;        // largest strain of a bond, in tension or compression
  double bond_modulus = 50000;    // Pa
  double min_bond_length = 1e-3;  // m, below which a bond exerts no force

  double entrained_density = 100;  // kg/m3
  double erosion_energy = 5000;    // J/kg; 0: all snow below the slide is entrained
  double entrainment_shear = 0;    // N/m2, resistance of the entrained snow against shear
  double entrainment_work = 0;     // J/kg, to break it up
  double split_ratio = 1.5;        // multiple of its fresh mass above which a particle splits

  double stop_ratio = 0.01;  // kinetic energy over its peak at which the slide has stopped
  int threads = 0;           // 0: all

  /// The smallest length that the method resolves, m; 0 if the terrain determines it.
  double resolution() const { return cell; }

  bool changes_ground() const {
    return ground_gains_stopped || ground_gains_detrained || ground_loses_entrained;
  }
};

/// The step of snow without bonds, s: the given one or, in the improved mode, a part of it so short
/// that particles take over at most a fifth of the mean velocity around them.
double longest_step(const Settings&);

}  // namespace snowshed::methods::slide
