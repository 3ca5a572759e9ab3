// Cost of a scene: its outline by arithmetic, and the method's estimate from it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/scene_view.hpp"
#include "snowshed/methods/surroundings.hpp"

namespace snowshed {

/// How far and how long the snow of an event moves: a slab slides off the panel and falls, bodies
/// fall, and the snow settles.
struct SnowMotion {
  bool slides = false;         // gravity overcomes the panel's friction
  double sliding_time = 0.0;   // s, until the slab's rear leaves the panel
  double fall_time = 0.0;      // s, of that rear or the last body; infinite if it never lands
  double first_landing = 0.0;  // s, when the front of the slab, or a body, reaches the ground
  double distance = 0.0;       // m, of the fastest snow, until it lands; within events.max_time
  double stretch = 1.0;        // length of snow that never lands, at the end, over that of the slab
  double event_time = 0.0;     // s, sliding, falling and settling; at most events.max_time
};

/// What a scene's solids and snow add up to, without building them.
struct SceneOutline {
  std::vector<Snow> snows;                   // by material_id
  std::vector<std::vector<double>> volumes;  // m3 (2D: m2) of the bodies of each event
  double particles_per_voxel = 0;
  double height = 0;             // m, of the snow of the first event above z = 0, or of itself
  std::vector<bool> conditions;  // by Condition: whether an obstacle has it
  bool has_moving_obstacle = false;
  bool has_domain = false;
  double obstacles = 0;         // how many
  double most_overlapping = 0;  // how many of them overlap where most do
  SnowMotion motion;
};

/// Estimates, in double because an absurd scene may ask for more than an integer holds.
struct CostEstimate {
  std::vector<double> particles;  // new in each event
  double total_particles = 0.0;   // sum over the events, what the last one carries
  double time_step = 0.0;         // s
  double event_time = 0.0;        // s, of an event; at most events.max_time
  double steps = 0.0;             // all events
  double updates = 0.0;           // of particles that are awake, all events
  double scattering = 1.0;        // work of an update where snow flies apart, over that at first
  double bytes = 0.0;             // peak memory, particles and grid
  std::vector<std::pair<std::string, double>> parts;  // of the particles, by name, if they have any
};

/// A feature of a method, and whether a scene uses it.
struct Feature {
  std::string name;
  bool used;
};

}  // namespace snowshed
