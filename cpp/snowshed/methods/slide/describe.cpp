#include "snowshed/methods/slide/describe.hpp"

#include "snowshed/methods/allowed.hpp"

namespace snowshed::methods::slide {

void describe(SettingsVisitor& v, Settings& s) {
  v.accuracy({"cell", "time_step", "layer_thickness"});
  v.choice("mode", s.mode,
           "Improved, without the known faults of com5SnowSlide, or compatible with AvaFrame 2.1 "
           "step by step");
  v.number("cell", s.cell, "m", allowed::size_or_zero,
           "Cells of the computing grid; 0: those of the terrain's raster");
  v.number("time_step", s.time_step, "s", positive.up_to(1.0), "Length of a step");
  v.number("density", s.density, "kg/m3", positive.up_to(1000.0).usual(20, 917),
           "Density of the sliding snow");
  v.number("layer_thickness", s.layer_thickness, "m", positive.up_to(100.0),
           "Snow of this thickness over a whole cell makes one particle");
  v.choice("friction_law", s.friction_law, "Friction with the ground");
  v.number("friction", s.friction, "", allowed::coefficient.usual(0.01, 2),
           "Coulomb coefficient mu");
  v.number("turbulence", s.turbulence, "m/s2", positive.up_to(1e6).usual(50, 1e5), "Voellmy's xi");
  v.flag("explicit_friction", s.explicit_friction,
         "Friction from the speed before the step; in the compatible mode only");
  v.number("resistance", s.resistance, "", non_negative.up_to(1e9),
           "Drag coefficient within resistance areas (forest, buildings)");
  v.number("detrainment", s.detrainment, "Pa", non_negative.up_to(1e6).usual(1, 200),
           "Detrainment coefficient K within resistance areas: snow of speed u loses the mass K/u "
           "per area and time; 0: none");
  v.number(
      "forest_min_speed", s.forest_min_speed, "m/s", non_negative.up_to(1000.0),
      "With detrainment, forest takes mass from snow up to this speed, and resists faster snow");
  v.number(
      "forest_min_thickness", s.forest_min_thickness, "m", non_negative.up_to(100.0),
      "With detrainment, forest takes mass from snow up to this thickness, and resists thicker "
      "snow");
  v.number("forest_max_speed", s.forest_max_speed, "m/s", positive.up_to(1000.0),
           "With detrainment, faster snow destroys the forest");
  v.number("forest_max_thickness", s.forest_max_thickness, "m", positive.up_to(100.0),
           "With detrainment, thicker snow destroys the forest");
  v.flag("ground_gains_stopped", s.ground_gains_stopped,
         "The ground rises where snow has stopped, which then moves no more");
  v.flag("ground_gains_detrained", s.ground_gains_detrained,
         "The ground rises where forest takes snow");
  v.flag("ground_loses_entrained", s.ground_loses_entrained,
         "The ground falls where the slide takes up snow");
  v.number("ground_min_change", s.ground_min_change, "m", non_negative.up_to(100.0),
           "The ground changes when the change at one node exceeds this depth");
  v.number("ground_rest_time", s.ground_rest_time, "s", non_negative.up_to(1e4),
           "Snow that rests as long as this is ground; in the improved mode only");
  v.number("artificial_viscosity", s.artificial_viscosity, "", non_negative.up_to(1e6),
           "AvaFrame's artificial viscosity; in the compatible mode only");
  v.choice("columns", s.columns,
           "Direction of the columns of snow that press on the ground; in the improved mode only");
  v.number("mixing_rate", s.mixing_rate, "1/s", non_negative.up_to(1000.0),
           "Rate at which particles take over the mean velocity around them; in the improved mode "
           "only");
  v.flag("bonds", s.bonds, "Cohesive bonds; without them a plain depth-averaged avalanche");
  v.number("max_strain", s.max_strain, "", positive.up_to(10.0),
           "Strain at which a bond breaks, in tension or compression");
  v.number("bond_modulus", s.bond_modulus, "Pa", non_negative.up_to(1e12),
           "Stiffness of the bonds (cohesive surface tension)");
  v.number("min_bond_length", s.min_bond_length, "m", allowed::size_or_zero,
           "Length below which a bond exerts no force");
  v.number("entrained_density", s.entrained_density, "kg/m3", positive.up_to(1000.0).usual(20, 917),
           "Density of the entrained snow");
  v.number(
      "erosion_energy", s.erosion_energy, "J/kg", non_negative.up_to(1e12),
      "Friction work that entrains a kilogram of snow; 0: all snow below the slide is entrained");
  v.number("entrainment_shear", s.entrainment_shear, "Pa", non_negative.up_to(1e12),
           "Shear strength of the entrained snow");
  v.number("entrainment_work", s.entrainment_work, "J/kg", non_negative.up_to(1e12),
           "Work that breaks up the entrained snow");
  v.number("split_ratio", s.split_ratio, "", Range{1.0, 1e6, true, false, Need::optional},
           "A particle splits when its mass exceeds this multiple of a fresh particle's");
  v.number("stop_ratio", s.stop_ratio, "", fraction,
           "The slide stops at this share of its largest kinetic energy");
  v.integer("threads", s.threads, non_negative.up_to(4096), "Threads; 0: all");
}

std::vector<UnusedSettings> unused_settings(const Settings& s, const TerrainSpec& terrain) {
  const std::vector<const char*> forest = {"forest_min_speed", "forest_min_thickness",
                                           "forest_max_speed", "forest_max_thickness"};
  const bool resists = !terrain.resistance.empty();
  return {{s.friction_law == FrictionLaw::coulomb, "friction_law is \"coulomb\"", {"turbulence"}},
          {!s.bonds, "bonds is false", {"max_strain", "bond_modulus", "min_bond_length"}},
          {!resists, "the terrain has no resistance", {"resistance", "detrainment"}},
          {!resists, "the terrain has no resistance", forest},
          {resists && s.detrainment == 0, "detrainment is 0", forest},
          {terrain.entrainment.empty(),
           "the terrain has no entrainment",
           {"entrained_density", "erosion_energy", "entrainment_shear", "entrainment_work"}}};
}

}  // namespace snowshed::methods::slide
