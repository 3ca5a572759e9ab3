// The form of what only the grains take: their sample, its loading and their settings. See
// describe.hpp.
#pragma once

#include "snowshed/scene/allowed.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Of a loading, so that its curve fits into memory.
inline constexpr int most_stages = 100;

template <class V>
void describe(V& v, SampleSpec& s) {
  v.file("file", s.file,
         "Segmented image: an NPY file of integers (nz, ny, nx), 0 air and any other number a "
         "grain; relative to the scene file");
  v.number("voxel_size", s.voxel_size, "m", between(1e-9, 1.0).required(), "Edge of a voxel");
  v.flag("split_labels", s.split_labels,
         "Whether each piece of a label that lies in several places is a grain; else all of them "
         "are one rigid grain");
}

template <class V>
void describe(V& v, LoadingStage& s) {
  v.choice("kind", s.kind,
           "What moves: the top plate down (compress), up until the stress has fallen (unload), up "
           "(stretch) or along x (shear); all sides inward (isotropic); a cone down (penetrate); "
           "nothing, until the snow rests (hold)");
  v.number("speed", s.speed, "m/s", positive.up_to(1e3), "Speed of what moves");
  v.number("strain", s.strain, "", positive.up_to(10.0),
           "Way over the sample's initial height at which the stage ends");
  v.number("stress", s.stress, "Pa", non_negative.up_to(1e12),
           "Stress that ends the stage (compress, isotropic; 0: none; unload), or is kept on the "
           "top plate (shear; 0: constant height)");
}

template <class V>
void describe(V& v, Cone& c) {
  v.number("radius", c.radius, "m", between(1e-9, 1.0), "Of the cone's base and the shaft");
  v.number("half_angle", c.half_angle, "degrees", positive.up_to(90.0),
           "Between the axis and the cone's side");
}

template <class V>
void describe(V& v, GrainsSettings& s) {
  v.accuracy({"density_scaling", "courant_factor"});
  v.number("elastic_modulus", s.elastic_modulus, "Pa", allowed::pressure,
           "Young's modulus of the contact law");
  v.number("stiffness_ratio", s.stiffness_ratio, "", positive.up_to(10.0),
           "Shear over normal stiffness of a contact");
  v.number("tensile_strength", s.tensile_strength, "Pa", non_negative.up_to(1e12),
           "Tensile strength of bonds");
  v.number("shear_strength", s.shear_strength, "Pa", non_negative.up_to(1e12),
           "Shear strength of bonds");
  v.number("friction", s.friction, "", allowed::coefficient,
           "Coulomb coefficient between grains, and between grains and plates");
  v.number("density", s.density, "kg/m3", positive.up_to(1e5), "Density of ice");
  v.number("density_scaling", s.density_scaling, "", between(1.0, 1e9),
           "Factor on the grains' inertia, for longer steps; their weight stays");
  v.number("damping", s.damping, "", non_negative.below(1.0),
           "Local damping: share of the unbalanced force that opposes the motion");
  v.number("courant_factor", s.courant_factor, "", positive.up_to(1.0),
           "Time step over the root of mass over stiffness");
  v.choice("sides", s.sides, "The vertical sides: rigid and frictionless, or periodic");
  v.flag("bonded_plates", s.bonded_plates, "Whether the snow is frozen to the plates");
  v.integer("threads", s.threads, non_negative.up_to(4096), "Threads; 0: all");
}

}  // namespace snowshed
