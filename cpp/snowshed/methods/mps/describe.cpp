#include "snowshed/methods/mps/describe.hpp"

#include "snowshed/methods/allowed.hpp"

namespace snowshed::methods::mps {

void describe(SettingsVisitor& v, Settings& s) {
  v.accuracy({"spacing", "radius", "max_time_step", "courant_factor", "pressure_tolerance",
              "viscosity_tolerance"});
  v.number("spacing", s.spacing, "m", allowed::size, "Distance between particles, l0");
  v.number("radius", s.radius, "", between(1.5, 4.5), "Radius of the weight function over l0");
  v.number("max_time_step", s.max_time_step, "s", positive.up_to(1.0), "Longest step");
  v.number("courant_factor", s.courant_factor, "", positive.up_to(0.4),
           "Longest displacement of a particle in a step, over l0");
  v.number("density", s.density, "kg/m3", positive.up_to(1e4).usual(20, 3000),
           "Density, which is constant");
  v.choice("rheology", s.rheology, "Law of the shear stress");
  v.choice("regularisation", s.regularisation, "Form of the yield stress at small shear rates");
  v.number("viscosity", s.viscosity, "Pa s", non_negative.up_to(1e6), "Plastic viscosity");
  v.number("cohesion", s.cohesion, "Pa", non_negative.up_to(1e6).usual(1, 1e5),
           "Yield stress without pressure (adhesive force)");
  v.number("friction_angle", s.friction_angle, "degrees", non_negative.below(90.0).usual(2, 90),
           "Inner friction angle: the yield stress grows with its tangent times the pressure");
  v.number("stress_growth", s.stress_growth, "s", positive.up_to(1e6),
           "Coefficient m with which the yield stress is approached");
  v.number("yield_strain", s.yield_strain, "", positive.up_to(0.1),
           "Shear strain at which snow with an elastoplastic stress yields");
  v.number("dilatant_rate", s.dilatant_rate, "1/s", positive.up_to(1e9),
           "Shear rate above which the stress grows as a power of the rate");
  v.number("dilatant_exponent", s.dilatant_exponent, "", between(1.0, 5.0),
           "Exponent of the stress above dilatant_rate");
  v.integer("yield_iterations", s.yield_iterations, between(1, 1000).usual(10, 1000),
            "Largest number of iterations for the apparent viscosity in a step");
  v.flag("erosion", s.erosion, "Whether snow is eroded and deposited");
  v.number("erodible_thickness", s.erodible_thickness, "m", allowed::size_or_zero,
           "Snow nearer to obstacles than this is erodible at the start");
  v.number("erosion_pressure", s.erosion_pressure, "Pa", non_negative.up_to(1e9),
           "Pressure above which erodible snow begins to move");
  v.number("erosion_speed", s.erosion_speed, "m/s", non_negative.up_to(1e4),
           "Speed of a neighbour above which erodible snow begins to move");
  v.number("deposition_pressure", s.deposition_pressure, "Pa", non_negative.up_to(1e9),
           "Pressure below which moving snow is deposited");
  v.number("deposition_speed", s.deposition_speed, "m/s", non_negative.up_to(1e4),
           "Speed below which moving snow is deposited");
  v.choice("walls", s.walls, "Walls: mirror images of the snow, or particles");
  v.choice("stress", s.stress,
           "Shear stress: viscous as published, or elastic until the snow yields");
  v.choice("source", s.source, "Right-hand side of the pressure equation");
  v.number("compensation", s.compensation, "", fraction,
           "Share of the density's error that a step removes");
  v.choice("gradient", s.gradient, "Gradient of the pressure");
  v.choice("splitting", s.splitting, "Whether viscosity acts before the pressure or after it");
  v.choice("coupling", s.coupling, "Steps in which pressure and viscosity are solved together");
  v.choice("surface", s.surface, "Position of zero pressure at the free surface");
  v.number("surface_ratio", s.surface_ratio, "", between(0.5, 1.0),
           "Number density over that of a lattice, below which a particle is at the surface");
  v.choice("order", s.order, "Order of the stages of a step: particles move as published, or once");
  v.choice("spacing_law", s.spacing_law, "Law that keeps particles apart besides the pressure");
  v.choice("preconditioner", s.preconditioner, "Preconditioner of the pressure equation");
  v.number("pressure_tolerance", s.pressure_tolerance, "", positive.up_to(0.1),
           "Residual of the pressure equation over its right-hand side");
  v.number("viscosity_tolerance", s.viscosity_tolerance, "", positive.up_to(0.1),
           "Residual of the viscous equation over the change by gravity in a step");
  v.integer("max_iterations", s.max_iterations, between(1, 100000),
            "Iterations after which a run ends with an error");
  v.integer("threads", s.threads, non_negative.up_to(4096), "Threads; 0: all");
}

std::vector<UnusedSettings> unused_settings(const Settings& s) {
  const bool newtonian = s.rheology == ShearLaw::newtonian;
  return {
      {!s.erosion,
       "erosion is false",
       {"erodible_thickness", "erosion_pressure", "erosion_speed", "deposition_pressure",
        "deposition_speed"}},
      {newtonian,
       "rheology is \"newtonian\"",
       {"cohesion", "friction_angle", "regularisation", "stress_growth", "yield_strain",
        "yield_iterations"}},
      {s.rheology != ShearLaw::bingham_dilatant,
       std::string("rheology is \"") + name_of(s.rheology) + "\"",
       {"dilatant_rate", "dilatant_exponent"}},
      {!newtonian && s.stress == Stress::published, "stress is \"published\"", {"yield_strain"}},
      {!newtonian && s.stress == Stress::elastoplastic,
       "stress is \"elastoplastic\"",
       {"regularisation", "stress_growth"}},
      {s.source == Source::published, "source is \"published\"", {"compensation"}}};
}

}  // namespace snowshed::methods::mps
