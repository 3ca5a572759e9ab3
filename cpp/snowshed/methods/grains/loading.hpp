// How a sample is loaded: stages, one after another.
#pragma once

namespace snowshed {

/// What moves in a stage. Plates are at the bottom, fixed, and at the top; sides see GrainSides.
/// `isotropic` has the speed as that of the height, and as stress the mean over top and sides.
/// `hold` ends when the kinetic energy has fallen to 1e-4 of its peak in the stage, or after the
/// time in which the speed would bring about the strain; `unload` ends at the strain, too.
enum class LoadingKind {
  compress,   // the top plate moves down
  unload,     // the top plate moves up, until the stress on it falls to `stress`
  stretch,    // the top plate moves up (bonded plates)
  shear,      // the top plate moves along x; at constant height, or under a constant normal stress
  isotropic,  // all six sides move inward at the same rate of strain (walls, or a shrinking period)
  penetrate,  // a cone is pushed down through the top, with the top plate away
  hold        // nothing moves, until the kinetic energy has gone
};

struct LoadingStage {
  LoadingKind kind = LoadingKind::compress;
  double speed = 0.02;  // m/s, of what moves
  double strain = 0.3;  // at which the stage ends: displacement over the sample's initial height
  double stress = 0;    // Pa; compress, isotropic: ends the stage if reached, 0: never;
                        // unload: see above; shear: normal stress, 0: constant height
};

/// The tip of a penetrometer: a cone with a shaft, along z.
struct Cone {
  double radius = 0.0025;  // m
  double half_angle = 30;  // degrees
};

}  // namespace snowshed
