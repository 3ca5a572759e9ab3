// The form of a scene, described once: key, member, unit, range and meaning of every field.
//
// `describe(visitor, object)` shows a visitor each field in turn. From it come reading (Reader),
// checking (Checker), writing (Writer), the JSON Schema (SchemaWriter) and the paths in error
// messages (Locator). Defaults are the members' initial values in scene.hpp. A visitor has:
//
//   version(key, number, doc)                a fixed number
//   number(key, member, unit, range, doc)    integer(key, member, range, doc)
//   number_instead(key, member, other, unit, range, doc)
//                                            an optional number that takes the place of another
//   flag(key, member, doc)                   text(key, member, doc)    file(key, member, doc)
//   choice(key, member, doc)                 an enumeration, see enum_names.hpp
//   vector(key, member, unit, range, doc)    [x, y, z], in 2D [x, z]; range of each component
//   direction(key, member, doc)              the same, any length but zero
//   axis(key, member, doc)                   a direction in 3D; absent in 2D, where it is +y
//   spin(key, member, unit, range, doc)      a vector in 3D; in 2D a number, about +y
//   outline(key, member, doc)                corners of an area on the map, [[x, y], ...]
//   object(key, member, need, doc)   optional(key, member, doc)   list(key, member, count, doc)
//   variants(key, member, doc), variant(name, doc)..., end_variants()
//                                            fields after variant(name) belong to that kind only
//   method(key, settings_key, member, doc, settings_doc)
//                                            the name of a method, and the settings of that method
//   read_method_first(key, member)           before parts that only some methods take
//   shows(key, member, part)                  whether to visit a part: does the method take it?
//   only_for_methods_with(part)              before a part: only methods that take it may have it
//   alias(key, other)                        before a field: another key for the same field
//   accuracy({key...})                       before fields: those that trade accuracy for time
#pragma once

#include "snowshed/methods/allowed.hpp"
#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/scene/describe_terrain.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed::methods {

template <>
struct EnumNames<scene::MisplacedSnow> {
  static constexpr Named<scene::MisplacedSnow> list[] = {{scene::MisplacedSnow::refuse, "refuse"},
                                                         {scene::MisplacedSnow::allow, "allow"}};
};

}  // namespace snowshed::methods

namespace snowshed::scene {

inline constexpr const char* condition_doc =
    "Snow in contact: sticks (sticky), slides and cannot leave (slip), slides and may leave "
    "(separate)";

template <class V>
void describe(V& v, material::Snow& s) {
  v.choice("model", s.model, "Law: cohesive Modified Cam-Clay, or elastic without yielding");
  const double before = s.density;
  v.number("density", s.density, "kg/m3", methods::positive.up_to(1000.0).usual(20, 917),
           "Initial bulk density; sets E and p0 unless given");
  if (s.density != before) s.scale_from_density(before);
  v.number("youngs_modulus", s.youngs_modulus, "Pa", methods::allowed::pressure.usual(1e4, 1e10),
           "Young's modulus E");
  v.number("poissons_ratio", s.poissons_ratio, "", methods::non_negative.below(0.5),
           "Poisson's ratio nu");
  v.number("critical_state_slope", s.critical_state_slope, "",
           methods::allowed::coefficient.usual(0.05, 3),
           "Slope M of the critical state line (internal friction)");
  v.number("preconsolidation_pressure", s.preconsolidation_pressure, "Pa",
           methods::allowed::pressure.usual(50, 1e7), "Initial preconsolidation pressure p0");
  v.number("cohesion", s.cohesion, "", methods::fraction,
           "Cohesion beta: tensile strength over p0");
  v.number("hardening_factor", s.hardening_factor, "",
           methods::positive.up_to(1e3).usual(1e-3, 100), "Hardening factor xi");
}

template <class V>
void describe(V& v, scene::ShapeSpec& s) {
  v.variants("type", s.type, "Kind of solid; it decides which other keys are allowed");
  if (v.variant("plane", "The half-space below a plane")) {
    v.vector("center", s.center, "m", methods::allowed::coordinate, "A point on the plane");
    v.direction("normal", s.normal, "Outward normal");
  }
  if (v.variant("box", "Box along the axes; unbounded along y in 2D")) {
    v.vector("center", s.center, "m", methods::allowed::coordinate, "Centre");
    v.vector("size", s.size, "m", methods::allowed::size.required(), "Edge lengths");
  }
  if (v.variant("sphere", "Ball; a disc in 2D")) {
    v.vector("center", s.center, "m", methods::allowed::coordinate, "Centre");
    v.number("radius", s.radius, "m", methods::allowed::size.required(), "Radius");
  }
  if (v.variant("cylinder", "Cylinder with flat ends")) {
    v.vector("from", s.from, "m", methods::allowed::coordinate.required(), "One end of the axis");
    v.vector("to", s.to, "m", methods::allowed::coordinate.required(), "The other end");
    v.number("radius", s.radius, "m", methods::allowed::size.required(), "Radius");
  }
  if (v.variant("capsule", "All points within a radius of a segment")) {
    v.vector("from", s.from, "m", methods::allowed::coordinate.required(),
             "One end of the segment");
    v.vector("to", s.to, "m", methods::allowed::coordinate.required(), "The other end");
    v.number("radius", s.radius, "m", methods::allowed::size.required(), "Radius");
  }
  if (v.variant("plate", "A rectangular board below its face")) {
    v.vector("center", s.center, "m", methods::allowed::coordinate, "Middle of the face");
    v.direction("normal", s.normal, "Outward normal of the face; not along y");
    v.number("length", s.length, "m", methods::allowed::size.required(), "Length, down the slope");
    v.number("width", s.width, "m", methods::allowed::size.required_in_3d(),
             "Width, across; ignored in 2D");
    v.number("thickness", s.thickness, "m", methods::allowed::size.required(),
             "Thickness, below the face");
  }
  if (v.variant("mesh", "Closed triangle mesh")) {
    v.file("file", s.file, "STL, OBJ or PLY file; relative to the scene file");
    v.number("scale", s.scale, "m", methods::positive.up_to(1e6), "Length of one unit of the file");
  }
  if (v.variant("grid", "Sampled signed distances")) {
    v.file("file", s.file, "NPY file; relative to the scene file");
    v.vector("origin", s.origin, "m", methods::allowed::coordinate, "Position of the first sample");
    v.number("spacing", s.spacing, "m", methods::allowed::size.required(),
             "Distance between samples");
  }
  if (v.variant("vdb", "Level set or fog volume of an OpenVDB file")) {
    v.file("file", s.file, "VDB file; relative to the scene file");
    v.text("grid", s.grid, "Name of the grid; empty: the only one of floats");
    v.number("scale", s.scale, "m", methods::positive.up_to(1e6), "Length of one unit of the file");
    v.number("threshold", s.threshold, "", methods::positive.up_to(1e6),
             "Threshold of a fog volume: the solid is where its value is larger");
  }
  if (v.variant("union", "Everything in any of the shapes")) {
    v.list("shapes", s.shapes, methods::between(1, 10000).required(), "The parts");
  }
  if (v.variant("difference", "The first shape without the others")) {
    v.list("shapes", s.shapes, methods::between(2, 10000).required(),
           "The body, then the shapes that are cut away");
  }
  if (v.variant("transform", "A shape, rotated about the origin and then moved")) {
    v.list("shapes", s.shapes, methods::exactly(1).required(), "The shape");
    v.axis("axis", s.axis, "Rotation axis");
    v.number("angle", s.angle, "degrees", methods::between(-360.0, 360.0).usual(3.2, 360),
             "Rotation about the axis");
    v.vector("translate", s.translate, "m", methods::allowed::coordinate,
             "Translation, after the rotation");
  }
  v.end_variants();
}

template <class V>
void describe(V& v, geometry::MotionSpec& m) {
  v.vector("velocity", m.velocity, "m/s", methods::allowed::speed.usual(0, 100), "Velocity");
  v.spin("angular_velocity", m.angular_velocity, "rad/s", methods::allowed::speed.usual(0, 50),
         "Angular velocity about the pivot");
  v.vector("pivot", m.pivot, "m", methods::allowed::coordinate,
           "Centre of the rotation; moves with the velocity");
  v.number("start", m.start, "s", methods::allowed::time,
           "Start of the motion, on the clock of the whole run");
  v.number("end", m.end, "s", methods::allowed::time, "End of the motion");
}

template <class V>
void describe(V& v, scene::ObstacleSpec& o) {
  v.text("name", o.name, "Name in messages and results");
  v.object("shape", o.shape, methods::Need::required, "The solid");
  v.choice("condition", o.condition, condition_doc);
  v.number("friction", o.friction, "", methods::allowed::coefficient.usual(0.01, 2),
           "Coulomb coefficient; unused when sticky");
  v.optional("motion", o.motion, "Prescribed rigid motion; fixed without it");
}

template <class V>
void describe(V& v, scene::BodySpec& b) {
  v.object("shape", b.shape, methods::Need::required, "The solid to fill with snow");
  v.vector("velocity", b.velocity, "m/s", methods::allowed::speed.usual(0, 100),
           "Initial velocity");
  v.integer("event", b.event, methods::non_negative.up_to(1000),
            "Event at whose start it appears, 1 the first; 0: at the start of every event");
  v.optional("snow", b.snow,
             "Snow of its own; values that are left out are those of the scene's snow");
  v.number("volume", b.volume, "m3", methods::non_negative.up_to(1e9),
           "Volume of its undeformed snow, in 2D m2, from which its mass follows; 0: the solid's");
}

template <class V>
void describe(V& v, scene::Panel& p) {
  v.alias("height", "lower_edge_height");  // the words of pvlib
  v.alias("length", "slant_height");
  v.alias("tilt", "surface_tilt");
  v.number("height", p.height, "m", methods::allowed::size_or_zero.required().usual(0.01, 20),
           "Vertical distance of the lower edge above the ground");
  v.number("length", p.length, "m", methods::allowed::size.required().usual(0.05, 40),
           "Length along the slope");
  v.number("width", p.width, "m", methods::allowed::size.required_in_3d().usual(0.05, 2000),
           "Width across the slope; ignored in 2D");
  v.number("tilt", p.tilt, "degrees", methods::non_negative.up_to(90.0).usual(3, 90),
           "Tilt from the horizontal");
  v.number("thickness", p.thickness, "m", methods::allowed::size_or_zero.usual(1e-4, 5),
           "Thickness, below the sliding face");
  v.choice("condition", p.condition, condition_doc);
  v.number("friction", p.friction, "", methods::allowed::coefficient.usual(0.01, 2),
           "Coulomb coefficient; unused when sticky");
}

template <class V>
void describe(V& v, scene::Layer& l) {
  v.number("thickness", l.thickness, "m", methods::allowed::size.required().usual(1e-3, 5),
           "Thickness, normal to the panel");
  v.optional("snow", l.snow,
             "Snow of its own; values that are left out are those of the scene's snow");
  v.integer("event", l.event, methods::non_negative.up_to(1000),
            "Event at whose start it is laid, 1 the first; 0: at the start of every event");
}

template <class V>
void describe(V& v, scene::Slab& s) {
  v.number("thickness", s.thickness, "m", methods::allowed::size_or_zero.usual(1e-3, 5),
           "Thickness, normal to the panel; 0: that of the layers");
  v.number("length", s.length, "m", methods::allowed::size_or_zero,
           "Length; 0: as long as the panel");
  v.number("width", s.width, "m", methods::allowed::size_or_zero,
           "Width; 0: two thirds of the panel's; ignored in 2D");
  v.list("layers", s.layers, methods::between(0, 1000),
         "Layers from the panel up, instead of a thickness");
}

template <class V>
void describe(V& v, scene::Ground& g) {
  v.number("tilt", g.tilt, "degrees",
           methods::Range{-60.0, 60.0, true, true, methods::Need::optional}.usual(2, 60),
           "Tilt; positive falls in the slide direction");
  v.choice("condition", g.condition, condition_doc);
  v.number("friction", g.friction, "", methods::allowed::coefficient.usual(0.01, 2),
           "Coulomb coefficient; unused when sticky");
}

/// Largest number of stages in a loading, so that its curve fits into memory.
inline constexpr int max_stages = 100;

template <class V>
void describe(V& v, methods::SampleSpec& s) {
  v.file("file", s.file,
         "Segmented image: an NPY file of integers (nz, ny, nx), 0 air and any other number a "
         "grain; relative to the scene file");
  v.number("voxel_size", s.voxel_size, "m",
           methods::between(1e-9, 1.0).required().usual(1e-6, 1e-3), "Edge of a voxel");
  v.flag("split_labels", s.split_labels,
         "Whether each connected piece of a label is a grain; else all pieces of a label are one "
         "rigid grain");
}

template <class V>
void describe(V& v, methods::LoadingStage& s) {
  v.choice("kind", s.kind,
           "Motion: the top plate down (compress), up until the stress has fallen (unload), up "
           "(stretch) or along x (shear); all sides inward (isotropic); a cone down (penetrate); "
           "nothing, until the snow rests (hold)");
  v.number("speed", s.speed, "m/s", methods::positive.up_to(1e3),
           "Speed of the plates or of the cone");
  v.number("strain", s.strain, "", methods::positive.up_to(10.0).usual(1e-6, 1),
           "Displacement over the sample's initial height at which the stage ends");
  v.number("stress", s.stress, "Pa", methods::non_negative.up_to(1e12),
           "Stress that ends the stage (compress, isotropic; 0: none; unload), or is kept on the "
           "top plate (shear; 0: constant height)");
}

template <class V>
void describe(V& v, methods::Cone& c) {
  v.number("radius", c.radius, "m", methods::between(1e-9, 1.0).usual(1e-4, 0.1),
           "Radius of the cone's base and of the shaft");
  v.number("half_angle", c.half_angle, "degrees", methods::positive.up_to(90.0).usual(3, 90),
           "Angle between the axis and the cone's side");
}

template <class V>
void describe(V& v, scene::Domain& d) {
  v.vector("min", d.min, "m", methods::allowed::coordinate.required(), "Lowest corner");
  v.vector("max", d.max, "m", methods::allowed::coordinate.required(), "Highest corner");
}

template <class V>
void describe(V& v, methods::Seeding& s) {
  v.accuracy({"particles_per_voxel", "pattern"});
  v.number("particles_per_voxel", s.particles_per_voxel, "", methods::non_negative.up_to(1000.0),
           "Particles per voxel of edge dx, at least 4 in 2D and 6 in 3D; 0: 6 in 2D, 8 in 3D");
  v.choice("pattern", s.pattern, "Arrangement of the particles");
  v.integer("seed", s.seed, methods::non_negative, "Seed of the random numbers");
  v.flag("allow_sparse", s.allow_sparse, "Accept fewer particles per voxel");
}

template <class V>
void describe(V& v, methods::Events& e) {
  v.integer("count", e.count, methods::between(1, 1000), "Number of slide-off events");
  v.choice("between", e.between,
           "Treatment of the stack between events: keep its particles, or reseed its volume");
  v.number("max_time", e.max_time, "s", methods::allowed::duration, "Longest duration of an event");
  v.number("rest_speed", e.rest_speed, "m/s", methods::positive.up_to(1e4).usual(1e-6, 1),
           "Speed below which the snow counts as resting");
  v.number("rest_time", e.rest_time, "s", methods::allowed::time,
           "Duration of rest that ends the event");
}

template <class V>
void describe(V& v, methods::Output& o) {
  v.number("snapshot_interval", o.snapshot_interval, "s", methods::allowed::time,
           "Simulated time between particle snapshots; 0: only at the end of an event");
  v.flag("film", o.film, "Record the particles over time, for snowshed view");
  v.number(
      "film_interval", o.film_interval, "s", methods::allowed::time,
      "Simulated time between frames of the film; 0: chosen by the expected duration of an event");
  v.flag("energy", o.energy, "Keep the energy balance");
  v.flag("forces", o.forces, "Record the forces between the snow and what it meets");
  v.number("force_interval", o.force_interval, "s", methods::between(1e-4, 1e9),
           "Simulated time between rows of forces.csv, each the mean since the row before");
  v.number("checkpoint_interval", o.checkpoint_interval, "s", methods::allowed::time,
           "Wall time between checkpoints; 0: none");
}

/// Gives a visitor the method's description of its settings.
template <class V>
class SettingsAdapter final : public methods::SettingsVisitor {
 public:
  explicit SettingsAdapter(V& v) : v_(v) {}

  void number(const char* key, double& value, const char* unit, const methods::Range& range,
              const char* doc) override {
    v_.number(key, value, unit, range, doc);
  }
  void number_instead(const char* key, std::optional<double>& value, const char* other,
                      const char* unit, const methods::Range& range, const char* doc) override {
    v_.number_instead(key, value, other, unit, range, doc);
  }
  void integer(const char* key, int& value, const methods::Range& range, const char* doc) override {
    v_.integer(key, value, range, doc);
  }
  void flag(const char* key, bool& value, const char* doc) override { v_.flag(key, value, doc); }
  void choice(const char* key, const methods::Choice& value, const char* doc) override {
    v_.choice(key, value, doc);
  }
  void alias(const char* key, const char* other) override { v_.alias(key, other); }
  void accuracy(std::initializer_list<const char*> keys) override { v_.accuracy(keys); }

 private:
  V& v_;
};

template <class V>
void describe(V& v, methods::MethodChoice& m) {
  SettingsAdapter<V> adapter(v);
  m->describe(adapter);
}

template <class V>
void describe(V& v, Scene& s) {
  v.version("snowshed", scene_version, "Version of the scene format");
  // Stands before any vector, because it decides how vectors are written.
  v.integer("dimension", s.dimension, methods::between(2, 3), "2: the plane (x, z); 3: space");
  v.text("title", s.title, "Title of the scene");
  v.number("gravity", s.gravity, "m/s2", methods::non_negative.up_to(1e3).usual(1, 30),
           "Gravity, along -z");
  v.choice("misplaced_snow", s.misplaced_snow,
           "Treatment of a scene that seeds more than 1 % of a body of snow inside an obstacle, "
           "below the ground, outside the domain, or within other snow");
  v.read_method_first("method", s.numerics);
  if (v.shows("snow", s.numerics, methods::Part::snow))
    v.object("snow", s.snow, methods::Need::optional, "The material");
  v.only_for_methods_with(methods::Part::panel);
  v.optional("panel", s.panel,
             "The panel; its centre is the origin of x, which points down the slide direction");
  v.only_for_methods_with(methods::Part::slab);
  v.optional("slab", s.slab, "The slab laid on the panel, centred, at the start of every event");
  v.only_for_methods_with(methods::Part::ground);
  v.optional("ground", s.ground, "An inclined plane through the origin");
  v.only_for_methods_with(methods::Part::terrain);
  v.optional("terrain", s.terrain,
             "Ground from a raster of elevations, with the areas of its snow");
  v.only_for_methods_with(methods::Part::sample);
  v.optional("sample", s.sample, "Segmented snow for a loading test");
  if (v.shows("loading", s.numerics,
              methods::Part::sample))  // other scenes, and their hashes, lack it
    v.list("loading", s.loading, methods::between(0, max_stages), "Stages of the loading test");
  v.only_for_methods_with(methods::Part::sample);
  v.optional("cone", s.cone, "Cone that the stages \"penetrate\" push in");
  v.only_for_methods_with(methods::Part::obstacles);
  v.list("obstacles", s.obstacles, methods::between(0, 10000),
         "Further solids that snow collides with");
  v.only_for_methods_with(methods::Part::bodies);
  v.list("bodies", s.bodies, methods::between(0, 10000), "Further bodies of snow");
  v.only_for_methods_with(methods::Part::domain);
  v.optional("domain", s.domain, "A box with sticky sides; unbounded without it");
  if (v.shows("seeding", s.numerics, methods::Part::seeding))
    v.object("seeding", s.seeding, methods::Need::optional, "Seeding of the snow with particles");
  v.method("method", "numerics", s.numerics, "The numerical method", "The method's settings");
  v.object("events", s.events, methods::Need::optional, "Number of events, and their end");
  v.object("output", s.output, methods::Need::optional, "Output during a run");
}

}  // namespace snowshed::scene
