// Progress of a loading test, and the motion of the grains' surroundings.
#pragma once

#include <vector>

#include "snowshed/methods/grains/boundary.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods::grains {

struct LoadingProgress {
  int stage = 0;            // stage being loaded; the number of stages when all are done
  double displacement = 0;  // m, since the stage began
  double duration = 0;      // s, since the stage began
  double peak_kinetic = 0;  // J, since the stage began
};

/// Measurements that decide when a stage ends.
struct LoadingGauge {
  double top_stress = 0, mean_stress = 0;  // Pa
  double kinetic = 0;                      // J; needed only in a stage of the kind `hold`
};

/// Properties of the sample that the loading needs.
struct LoadedSample {
  Vec3 box;                  // m, at the beginning
  double radius;             // m, of the spheres
  double contact_stiffness;  // N/m
};

/// A stage of the kind `hold` ends when the kinetic energy has fallen to this share of its peak in
/// the stage.
inline constexpr double rest_per_peak = 1e-4;

/// The plates, sides and cone of a sample that is not loaded yet.
Boundary initial_boundary(const LoadedSample&);

/// Prepares the present stage: `penetrate` removes the top plate and adds the cone.
void begin_stage(const std::vector<LoadingStage>&, const LoadedSample&, const LoadingProgress&,
                 Boundary&);

/// Sets the velocities for a step of this length. In shear under a normal stress the top plate's
/// vertical speed controls the stress: it corrects the error of the force, divided by the stiffness
/// of the plate's contacts, within five steps, and is at most the stage's speed.
void set_velocities(const std::vector<LoadingStage>&, const LoadedSample&, const LoadingProgress&,
                    double dt, Boundary&);

/// Counts a step, and begins the next stage if this one has ended.
void count_step(const std::vector<LoadingStage>&, const LoadedSample&, const LoadingGauge&,
                double dt, LoadingProgress&, Boundary&);

}  // namespace snowshed::methods::grains
