// Dams: lines on the map that hold or deflect snow, up to the height of their crown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/geometry/point2.hpp"
#include "snowshed/methods/slide/terrain.hpp"

namespace snowshed::methods::slide {

struct Model;
struct State;
struct Workspace;

/// A dam as the scene gives it. Coordinates are given from the south-west node of the terrain.
struct Dam {
  struct Corner {
    double x, y, height;  // m; height of the crown above the ground
  };
  std::string name;
  std::vector<Corner> corners;
  double slope = 90;       // degrees, of the face on the left of the line
  double restitution = 0;  // share of the speed toward the dam with which snow leaves it
};

/// The foot of a dam's face, along which snow meets it.
struct DamFoot {
  struct Point {
    double x, y;    // m
    Vec3 crown;     // m, above the point
    double height;  // m
  };
  std::vector<Point> points;
  std::vector<Vec3> tangents;  // one for each section of the line on the ground
  double restitution;
};

/// A crossing of a path with a section of a dam.
struct DamCrossing {
  std::size_t dam = 0, section = 0;
  double along_path = 0, along_section = 0;  // 0 to 1
};

class DamFeet {
 public:
  DamFeet() = default;
  /// In the improved mode the foot is the dam's line; in the compatible mode it lies on the left of
  /// the line, where a face of the dam's slope meets the ground. Throws InputError if it lies
  /// beyond the terrain.
  DamFeet(const std::vector<Dam>&, const Terrain&, bool compatible);

  bool empty() const { return feet_.empty(); }
  std::size_t size() const { return feet_.size(); }
  std::size_t sections() const;
  const DamFoot& operator[](std::size_t i) const { return feet_[i]; }

  /// Whether a dam may be in reach of a cell: in it or in one beside it.
  bool is_near(std::size_t cell) const { return near_[cell] != 0; }

 private:
  void mark_near(const DamFoot&, const Terrain&);

  std::vector<DamFoot> feet_;
  std::vector<char> near_;
};

/// The snow that passed a dam; a particle counts each time.
struct DamFact {
  std::string name;
  double passed;  // kg
};

/// Lets the dams act on the particles that the step has moved from their positions before it
/// (`work.positions_before`). Marks particles that leave the terrain in `work.removed`. Updates the
/// kinetic energy, the energy that dams took, and the mass that has passed each dam.
///
/// Improved mode: a dam is a vertical wall. Snow passes it if its energy suffices to climb from the
/// snow's surface to the crown, and loses this energy. Other snow is thrown back with the
/// restitution of the speed normal to the wall, and keeps the speed along it.
///
/// Compatible mode: as AvaFrame 2.1 with one contact in a step. The wall is inclined as the line
/// from the middle of the snow at the foot to the crown, so that snow which fills a dam is thrown
/// upward, and thus over it.
void apply_dams(const Model&, State&, Workspace&);

}  // namespace snowshed::methods::slide
