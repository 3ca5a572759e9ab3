// The form of a scene's terrain and of what lies on it; see describe.hpp.
#pragma once

#include "snowshed/methods/allowed.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::scene {

template <class V>
void describe(V& v, methods::HoleSpec& h) {
  v.outline("outline", h.outline, "Corners, in the terrain's coordinates");
}

/// The name and the shape of an area.
template <class V, class Area>
void describe_polygon(V& v, Area& a) {
  v.text("name", a.name, "Name in messages and results");
  v.outline("outline", a.outline, "Corners, in the terrain's coordinates");
  v.list("holes", a.holes, methods::between(0, 1000),
         "Parts within the outline that do not belong to it");
}

template <class V>
void describe(V& v, methods::AreaSpec& a) {
  describe_polygon(v, a);
  v.number("thickness", a.thickness, "m", methods::positive.up_to(100.0).required().usual(0.02, 4),
           "Thickness of the snow, normal to the ground");
}

template <class V>
void describe(V& v, methods::ResistanceSpec& r) {
  describe_polygon(v, r);
}

template <class V>
void describe(V& v, methods::PulseSpec& p) {
  v.number("time", p.time, "s", methods::non_negative.up_to(1e9), "Time at which the snow enters");
  v.number("thickness", p.thickness, "m", methods::positive.up_to(100.0).required().usual(0.02, 4),
           "Thickness of the snow over the whole area, normal to the ground");
  v.number("speed", p.speed, "m/s", methods::non_negative.up_to(200.0),
           "Speed of the snow, down the slope");
}

template <class V>
void describe(V& v, methods::InflowSpec& i) {
  describe_polygon(v, i);
  v.flag("bonds", i.bonds,
         "Whether the snow of each time is a slab with bonds; in the mode \"improved\" only");
  v.list("hydrograph", i.hydrograph, methods::between(1, 1000).required(),
         "Times at which snow enters the area, with its thickness and speed");
}

template <class V>
void describe(V& v, methods::DamCornerSpec& c) {
  v.number("x", c.x, "m", methods::allowed::map_coordinate.required(), "Map coordinate along x");
  v.number("y", c.y, "m", methods::allowed::map_coordinate.required(), "Map coordinate along y");
  v.number("height", c.height, "m", methods::positive.up_to(1000.0).required().usual(1, 40),
           "Height of the crown above the ground");
}

template <class V>
void describe(V& v, methods::DamSpec& d) {
  v.text("name", d.name, "Name in messages and results");
  v.list("corners", d.corners, methods::between(2, 1000).required(),
         "Corners of the line of its crown");
  v.number("slope", d.slope, "deg", methods::positive.up_to(90.0),
           "Slope of its face, on the left of the line; in the mode \"compatible\" only, in the "
           "other one dams are vertical");
  v.number("restitution", d.restitution, "", methods::fraction,
           "Share of the speed toward the dam with which snow leaves it");
}

template <class V>
void describe(V& v, methods::TerrainSpec& t) {
  v.file("file", t.file, "Elevations, m: an ESRI ASCII grid; relative to the scene file");
  v.text("crs", t.crs, "Coordinate system of the raster and the areas, passed on to the results");
  v.flag("single_precision", t.single_precision,
         "Whether the mode \"compatible\" rounds elevations to single precision, as AvaFrame reads "
         "text");
  v.text("thickness_file", t.thickness_file,
         "Thickness of the released snow, m, in place of that of the areas: an ESRI ASCII grid; "
         "relative to the scene file");
  v.number("max_thickness", t.max_thickness, "m", methods::positive.up_to(100.0),
           "Largest thickness of the snow that is released or entrained");
  v.number("max_slope", t.max_slope, "deg", methods::positive.up_to(90.0),
           "Steepest ground between neighbouring nodes under a release, where they differ by more "
           "than 10 m in height");
  v.text("notes", t.notes, "Assumptions about the files, one a line, passed on to the results");
  v.number("release_speed", t.release_speed, "m/s", methods::non_negative.up_to(200.0),
           "Speed of the snow of `release` at the start, down the slope");
  v.list("release", t.release, methods::between(1, 10000).required(), "Areas of release");
  v.list("secondary_release", t.secondary_release, methods::between(0, 1000),
         "Areas that are released when snow of the slide enters them");
  v.list("inflows", t.inflows, methods::between(0, 1000), "Areas that snow enters at given times");
  v.list("entrainment", t.entrainment, methods::between(0, 10000),
         "Areas where the slide entrains snow");
  v.list("resistance", t.resistance, methods::between(0, 10000),
         "Areas where forest or buildings resist the slide");
  v.list("dams", t.dams, methods::between(0, 1000), "Dams that hold or deflect the slide");
}

}  // namespace snowshed::scene
