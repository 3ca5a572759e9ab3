#include "snowshed/methods/grains/loading_progress.hpp"

#include <algorithm>

namespace snowshed::methods::grains {
namespace {

/// Number of steps in which the top plate corrects an error of its force. The plate thus acts as a
/// dashpot, which takes energy and cannot excite vibrations. The correction is stable for any value
/// of at least 1.
constexpr double servo_steps = 5;

/// Upward velocity with which the force on the top plate approaches that of the stage.
double servo_speed(const LoadingStage& stage, const LoadedSample& sample, const Boundary& b,
                   double dt) {
  const double excess = b.plate_force[1].z() - stage.stress * sample.box.x() * sample.box.y();
  const double stiffness =
      sample.contact_stiffness * double(std::max<std::int64_t>(1, b.top_contacts));
  return std::clamp(excess / (stiffness * servo_steps * dt), -stage.speed, stage.speed);
}

bool has_ended(const LoadingStage& stage, const LoadedSample& sample, const LoadingGauge& gauge,
               const LoadingProgress& progress) {
  const double end = stage.strain * sample.box.z();
  switch (stage.kind) {
    case LoadingKind::hold:
      return gauge.kinetic <= rest_per_peak * progress.peak_kinetic ||
             progress.duration * stage.speed >= end;
    case LoadingKind::unload:
      return gauge.top_stress <= stage.stress || progress.displacement >= end;
    case LoadingKind::compress:
      return (stage.stress > 0 && gauge.top_stress >= stage.stress) || progress.displacement >= end;
    case LoadingKind::isotropic:
      return (stage.stress > 0 && gauge.mean_stress >= stage.stress) ||
             progress.displacement >= end;
    default:
      return progress.displacement >= end;
  }
}

}  // namespace

Boundary initial_boundary(const LoadedSample& sample) {
  Boundary b;
  b.plate[0] = Vec3(0, 0, -sample.radius);
  b.plate[1] = Vec3(0, 0, sample.box.z() + sample.radius);
  b.side[1] = sample.box.x();
  b.side[3] = sample.box.y();
  return b;
}

void begin_stage(const std::vector<LoadingStage>& stages, const LoadedSample& sample,
                 const LoadingProgress& progress, Boundary& b) {
  if (progress.stage >= int(stages.size()) || b.has_cone) return;
  if (stages[std::size_t(progress.stage)].kind != LoadingKind::penetrate) return;
  b.has_top = false;
  b.has_cone = true;
  b.tip = Vec3(0.5 * (b.side[0] + b.side[1]), 0.5 * (b.side[2] + b.side[3]),
               b.plate[1].z() - sample.radius);
}

void set_velocities(const std::vector<LoadingStage>& stages, const LoadedSample& sample,
                    const LoadingProgress& progress, double dt, Boundary& b) {
  for (Vec3* v : {&b.plate_velocity[0], &b.plate_velocity[1], &b.tip_velocity}) v->setZero();
  for (double& v : b.side_velocity) v = 0;
  if (progress.stage >= int(stages.size())) return;
  const LoadingStage& stage = stages[std::size_t(progress.stage)];
  switch (stage.kind) {
    case LoadingKind::compress:
      b.plate_velocity[1].z() = -stage.speed;
      break;
    case LoadingKind::unload:
    case LoadingKind::stretch:
      b.plate_velocity[1].z() = stage.speed;
      break;
    case LoadingKind::shear:
      b.plate_velocity[1].x() = stage.speed;
      if (stage.stress > 0) b.plate_velocity[1].z() = servo_speed(stage, sample, b, dt);
      break;
    case LoadingKind::isotropic:
      b.plate_velocity[0].z() = 0.5 * stage.speed;
      b.plate_velocity[1].z() = -0.5 * stage.speed;
      for (int s = 0; s < 4; ++s)
        b.side_velocity[s] =
            (s % 2 == 0 ? 0.5 : -0.5) * stage.speed * sample.box[s / 2] / sample.box.z();
      break;
    case LoadingKind::penetrate:
      b.tip_velocity.z() = -stage.speed;
      break;
    case LoadingKind::hold:
      break;
  }
}

void count_step(const std::vector<LoadingStage>& stages, const LoadedSample& sample,
                const LoadingGauge& gauge, double dt, LoadingProgress& progress, Boundary& b) {
  if (progress.stage >= int(stages.size())) return;
  const LoadingStage& stage = stages[std::size_t(progress.stage)];
  if (stage.kind != LoadingKind::hold) progress.displacement += dt * stage.speed;
  progress.duration += dt;
  progress.peak_kinetic = std::max(progress.peak_kinetic, gauge.kinetic);
  if (!has_ended(stage, sample, gauge, progress)) return;
  progress = {progress.stage + 1, 0, 0, 0};
  begin_stage(stages, sample, progress, b);
}

}  // namespace snowshed::methods::grains
