#include "snowshed/methods/grains/describe.hpp"

#include "snowshed/methods/allowed.hpp"

namespace snowshed::methods::grains {

void describe(SettingsVisitor& v, Settings& s) {
  v.accuracy({"density_scaling", "courant_factor"});
  v.number("elastic_modulus", s.elastic_modulus, "Pa", allowed::pressure.usual(1e4, 1e11),
           "Young's modulus of the contact law");
  v.number("stiffness_ratio", s.stiffness_ratio, "", positive.up_to(10.0),
           "Shear over normal stiffness of a contact");
  v.number("tensile_strength", s.tensile_strength, "Pa", non_negative.up_to(1e12).usual(100, 1e9),
           "Tensile strength of bonds");
  v.number("shear_strength", s.shear_strength, "Pa", non_negative.up_to(1e12).usual(100, 1e9),
           "Shear strength of bonds");
  v.number("friction", s.friction, "", allowed::coefficient.usual(0.01, 2),
           "Coulomb coefficient between grains, and between grains and plates");
  v.number("density", s.density, "kg/m3", positive.up_to(1e5).usual(500, 3000), "Density of ice");
  v.number("density_scaling", s.density_scaling, "", between(1.0, 1e9),
           "Factor on the grains' inertia, for longer steps; their weight stays");
  v.number("damping", s.damping, "", non_negative.below(1.0),
           "Local damping: share of the unbalanced force that opposes the motion");
  v.number("courant_factor", s.courant_factor, "", positive.up_to(1.0),
           "Time step relative to sqrt(m/k), the smallest of all grains");
  v.choice("sides", s.sides, "The vertical sides: rigid and frictionless, or periodic");
  v.flag("bonded_plates", s.bonded_plates, "Whether the snow is frozen to the plates");
  v.integer("threads", s.threads, non_negative.up_to(4096), "Threads; 0: all");
}

}  // namespace snowshed::methods::grains
