// A scene to simulate, as plain data in SI units. One JSON form reads and writes exactly these
// fields (scene_json.hpp); nothing here computes anything.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/geometry/rigid_motion.hpp"
#include "snowshed/material/snow.hpp"
#include "snowshed/methods/contact_law.hpp"
#include "snowshed/methods/method_choice.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::scene {

// Oldest version that is read, see earlier_version.hpp.
inline constexpr int oldest_scene_version = 1;
inline constexpr int scene_version = 2;

/// A solid. `type` selects which of the other fields count.
struct ShapeSpec {
  // plane box sphere cylinder capsule plate mesh grid vdb union difference transform
  std::string type;
  Vec3 center = Vec3::Zero();   // box, sphere; a point on a plane; middle of a plate's face
  Vec3 size = Vec3::Zero();     // box: edge lengths (y is unbounded in 2D)
  Vec3 normal = Vec3::UnitZ();  // plane, plate: outward normal
  Vec3 from = Vec3::Zero();     // cylinder, capsule: ends of the axis
  Vec3 to = Vec3::Zero();
  double radius = 0.0;            // sphere, cylinder, capsule
  double length = 0.0;            // plate: along the slope
  double width = 0.0;             // plate: across (ignored in 2D)
  double thickness = 0.0;         // plate: below its face
  std::string file;               // mesh (.stl .obj .ply), grid (.npy), vdb
  double scale = 1.0;             // mesh, vdb: file units to metres
  Vec3 origin = Vec3::Zero();     // grid: position of the first sample
  double spacing = 0.0;           // grid: metres between samples
  std::string grid;               // vdb: name of the grid; empty: the only one of floats
  double threshold = 0.5;         // vdb, a fog volume: threshold of the solid
  Vec3 translate = Vec3::Zero();  // transform: applied after the rotation
  Vec3 axis = Vec3::UnitY();      // transform: rotation axis
  double angle = 0.0;             // transform: degrees
  std::vector<ShapeSpec> shapes;  // union, difference (first minus the rest), transform (one)
};

/// A solid with which snow collides.
struct ObstacleSpec {
  std::string name;
  ShapeSpec shape;
  methods::Condition condition = methods::Condition::separate;
  double friction = 0.3;  // Coulomb coefficient; unused when sticky
  std::optional<geometry::MotionSpec> motion;
};

/// A body of snow that appears at the start of event `event` (1 is the first; 0: at the start of
/// every event).
struct BodySpec {
  ShapeSpec shape;
  Vec3 velocity = Vec3::Zero();  // m/s
  int event = 1;
  std::optional<material::Snow> snow;  // none: the scene's
  double volume = 0;                   // m3, in 2D m2; 0: that of the solid
};

/// The panel of Figure 3.1.1: x points down the slide direction, z up, the origin of x is
/// the panel's centre; the lower edge stands `height` above the ground.
struct Panel {
  double height = 0.0;     // m
  double length = 0.0;     // m, along the slope
  double width = 0.0;      // m, 3D only
  double tilt = 40.0;      // degrees from horizontal
  double thickness = 0.0;  // m, below the sliding face
  methods::Condition condition = methods::Condition::separate;
  double friction = 0.3;
};

/// A layer of the slab, over its whole length and width.
struct Layer {
  double thickness = 0.0;              // m
  std::optional<material::Snow> snow;  // none: the scene's
  int event = 0;                       // at whose start it is laid, 1 the first; 0: of every event
};

/// The slab laid on the panel at the start of every event: of the scene's snow, or layer by layer.
struct Slab {
  double thickness = 0.0;     // m; 0: that of the layers together
  double length = 0.0;        // m; 0: as long as the panel
  double width = 0.0;         // m; 0: two thirds of the panel's width
  std::vector<Layer> layers;  // from the panel upwards
};

/// An inclined plane through the origin; positive tilt falls in the slide direction.
struct Ground {
  double tilt = 0.0;  // degrees
  methods::Condition condition = methods::Condition::sticky;
  double friction = 0.3;
};

/// Treatment of a scene that seeds more than 1 % of a body of snow where none may be.
enum class MisplacedSnow { refuse, allow };

struct Domain {
  Vec3 min = Vec3::Zero();  // m
  Vec3 max = Vec3::Zero();
};

struct Scene {
  int dimension = 3;
  std::string title;
  double gravity = 9.81;  // m/s2, along -z
  MisplacedSnow misplaced_snow = MisplacedSnow::refuse;
  material::Snow snow;
  std::optional<Panel> panel;
  std::optional<Slab> slab;
  std::optional<Ground> ground;
  std::optional<methods::TerrainSpec> terrain;
  std::optional<methods::SampleSpec> sample;
  std::vector<methods::LoadingStage> loading;  // stages of the sample, one after another
  std::optional<methods::Cone> cone;           // none: the default one, if a stage asks for it
  std::vector<ObstacleSpec> obstacles;
  std::vector<BodySpec> bodies;
  std::optional<Domain> domain;  // its sides are sticky walls; none: unbounded
  methods::Seeding seeding;
  methods::MethodChoice numerics;  // the method that the scene chooses, with its settings
  methods::Events events;
  methods::Output output;
};

/// The methods' view of a scene, to which it refers.
inline methods::SceneView view_of(const Scene& s) {
  return {s.dimension, s.gravity, s.terrain, s.sample, s.loading, s.cone, s.events, s.output};
}

}  // namespace snowshed::scene
