// Effects of the ground on snow: weight, friction, curvature.
#pragma once

#include "snowshed/methods/slide/kernels/cell_positions.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// Draws a velocity toward the mean velocity of the surrounding snow, implicitly (artificial
/// viscosity of SamosAT).
SNOWSHED_INLINE PackVec with_artificial_viscosity(const View& s, const PackVec& u,
                                                  const PackVec& mean_velocity,
                                                  const PackVec& normal, const Pack& mass,
                                                  const Pack& thickness) {
  const PackVec v = mean_velocity - dot(mean_velocity, normal) * normal, difference = v - u;
  const Pack side_per_mass = 2.0 * length_from(Pack(thickness / (s.density * mass)));
  const Pack rate =
      s.viscosity * 0.5 * s.density * length_from(dot(difference, difference)) * side_per_mass;
  const Pack f = s.time_step * rate;
  return Pack(1.0 / (1.0 + f)) * (u + f * v);
}

/// Default mode: takes over a share of the mean velocity of the surrounding snow. The share is
/// proportional to the step, so that the motion does not depend on it.
SNOWSHED_INLINE PackVec mixed_with(const View& s, const PackVec& u, const PackVec& mean_velocity,
                                   const PackVec& normal) {
  const PackVec v = mean_velocity - dot(mean_velocity, normal) * normal;
  return u + broadcast<Pack>(s.mixed_share) * (v - u);
}

/// Velocities after artificial viscosity, and the positions that they reach without forces.
struct PackPrediction {
  PackVec velocity, position;
  PackReprojection on_ground;
  PackGround ground;
};

SNOWSHED_INLINE void predict(const View& s, const Lanes& l, PackPrediction& predicted) {
  const Pack thickness = l.load(s.thickness);
  const Pack h = max(thickness, broadcast<Pack>(min_thickness));
  const PackRecord flow = flow_at(s, stored_position(s, l));
  const PackVec before = l.load(s.ux, s.uy, s.uz), normal = l.load(s.nx, s.ny, s.nz);
  const PackVec mean{flow.b, flow.c, flow.d};
  const PackVec u = s.scheme == FrictionScheme::set_valued
                        ? mixed_with(s, before, mean, normal)
                        : with_artificial_viscosity(s, before, mean, normal, l.load(s.mass), h);
  predicted.velocity = u;
  predicted.position = l.load(s.x, s.y, s.z) + broadcast<Pack>(s.time_step) * u;
  l.store(s.speed, length_from(dot(u, u)));
  l.store(s.ux, s.uy, s.uz, u);
  l.store_records(s.predicted,
                  {predicted.position.x, predicted.position.y, predicted.position.z, thickness});
}

/// Weight and friction, with the mean of the ground's normals at both ends of the path.
SNOWSHED_INLINE void load_ground(const View& s, const Lanes& l, const PackPrediction& predicted) {
  const PackVec normal = l.load(s.nx, s.ny, s.nz);
  const PackMask stays = predicted.on_ground.on_ground.inside & predicted.ground.known;
  const PackVec end = select(stays, predicted.ground.normal, normal), sum = normal + end;
  const PackVec mean = inverse_sqrt(dot(sum, sum)) * sum;
  const Pack curvature = dot(predicted.velocity, end - normal) * (1 / s.time_step);
  const Pack along_normal = -s.gravity * mean.z;
  // Friction does not act on snow that leaves the ground.
  const Pack normal_acceleration = max(Pack{}, Pack(-(along_normal + curvature)));  // m/s2
  const Pack h = max(l.load(s.thickness), broadcast<Pack>(min_thickness));
  const Pack drag =
      select(normal_acceleration > 0.0, Pack(s.friction_drag / (s.density * h)), Pack{});

  PackVec acceleration = Pack(-along_normal) * mean;
  acceleration.z -= s.gravity;
  l.store(s.ax, s.ay, s.az, acceleration);
  l.store(s.coulomb_deceleration, s.friction * normal_acceleration);
  l.store(s.drag, drag);
}

SNOWSHED_INLINE void ground_batch(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end,
                                  int packs) {
  PackPrediction predicted[packs_in_batch];
  for (int k = 0; k < packs; ++k) predict(s, lanes_of(begin, end, k), predicted[k]);
  for (int k = 0; k < packs; ++k) {
    const PackVec& x = predicted[k].position;
    predicted[k].on_ground = reproject(s, x.x, x.y, x.z, all_lanes);
  }
  for (int k = 0; k < packs; ++k)
    predicted[k].ground = ground_at(s, predicted[k].on_ground.on_ground);
  for (int k = 0; k < packs; ++k) load_ground(s, lanes_of(begin, end, k), predicted[k]);
}

SNOWSHED_MODULE_VARIANT_END
