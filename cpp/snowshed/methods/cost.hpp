// Cost of a scene: its outline by arithmetic, and the method's estimate from the outline.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/scene_view.hpp"
#include "snowshed/methods/surroundings.hpp"

namespace snowshed::methods {

/// Distance and duration of the motion of an event's snow: a slab slides off the panel and falls,
/// bodies fall, and the snow settles.
struct SnowMotion {
  bool slides = false;         // gravity overcomes the panel's friction
  double sliding_time = 0.0;   // s, until the slab's rear leaves the panel
  double fall_time = 0.0;      // s, of the rear or the last body; infinite if it never lands
  double first_landing = 0.0;  // s, when the front of the slab, or a body, reaches the ground
  double distance = 0.0;       // m, of the fastest snow, until it lands; within events.max_time
  double stretch = 1.0;        // final length of snow that never lands, over the slab's length
  double event_time = 0.0;     // s, sliding, falling and settling; at most events.max_time
};

/// Totals of a scene's solids and snow, computed without building them.
struct SceneOutline {
  std::vector<material::Snow> snows;         // indexed by material_id
  std::vector<std::vector<double>> volumes;  // m3 (2D: m2) of the bodies of each event
  double particles_per_voxel = 0;
  double height = 0;             // m, of the snow of the first event above z = 0, or of itself
  std::vector<bool> conditions;  // indexed by Condition: whether an obstacle has it
  bool has_moving_obstacle = false;
  bool has_domain = false;
  double obstacles = 0;    // number of obstacles
  double max_overlap = 0;  // largest number of obstacles that overlap at a point
  SnowMotion motion;
};

/// Estimates, in double because an absurd scene may ask for more than an integer holds.
struct CostEstimate {
  std::vector<double> particles;  // new in each event
  double total_particles = 0.0;   // sum over the events; all take part in the last one
  double time_step = 0.0;         // s
  double event_time = 0.0;        // s, of an event; at most events.max_time
  double steps = 0.0;             // all events
  double updates = 0.0;           // updates of awake particles, all events
  double scattering = 1.0;        // work of an update in scattered snow, relative to a slab
  double bytes = 0.0;             // peak memory, particles and grid
  double card_bytes = 0.0;        // memory of a graphics card, if the settings may use one
  // Named parts of the particle count, if there are any.
  std::vector<std::pair<std::string, double>> parts;
};

/// A feature of a method, and whether a scene uses it.
struct Feature {
  std::string name;
  bool used;
};

}  // namespace snowshed::methods
