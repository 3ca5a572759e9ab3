// What a scene will cost, by arithmetic alone: nothing is seeded or simulated.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// Estimates, in double because an absurd scene may ask for more than an integer holds.
struct CostEstimate {
  std::vector<double> particles;  // new in each event
  double total_particles = 0.0;   // sum over the events, what the last one carries
  double wave_speed = 0.0;        // m/s, elastic, of the initial snow; the fastest
  double time_step = 0.0;         // s
  bool slides = false;            // gravity overcomes the panel's friction
  double slide_time = 0.0;        // s, until the slab's rear leaves the panel
  double fall_time = 0.0;         // s, of that rear or the last body; infinite if it never lands
  double first_landing = 0.0;     // s, when the front of the slab, or a body, reaches the ground
  double way = 0.0;               // m, of the fastest snow, until it lands; within events.max_time
  double event_time = 0.0;        // s, sliding, falling and settling; at most events.max_time
  double steps = 0.0;             // all events
  double updates = 0.0;           // of particles that are awake, all events
  double scattering = 1.0;        // work of an update where snow flies apart, over that at first
  double bytes = 0.0;             // peak memory, particles and grid
  std::vector<std::pair<std::string, double>> parts;  // of which particles consist, if of any
};

/// `particles`, new in each event, replace the estimate from the volumes, which leaves out snow
/// whose volume the scene does not tell (meshes and grids).
CostEstimate estimate_cost(const Scene& scene);
CostEstimate estimate_cost(const Scene& scene, std::vector<double> particles);

/// The first time step of a scene at rest, of its stiffest snow (mpm/time_step.hpp), s.
double stable_time_step(const Scene& scene);

/// Throws InputError, naming what is to blame, where an event would take more steps than any run
/// has time for (10^12), or be recorded more than a million times.
void check_duration(const Scene&, const CostEstimate&);

/// Throws InputError naming both numbers when `bytes` exceeds `available`; by default the memory
/// of the machine, or of the container where it has less.
void check_memory(double bytes);
void check_memory(double bytes, double available);

}  // namespace snowshed
