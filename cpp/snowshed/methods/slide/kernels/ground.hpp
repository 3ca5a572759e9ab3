// Effects of the ground on snow: weight, friction, curvature.
#pragma once

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// Draws a velocity toward that of the snow around, implicitly (artificial viscosity of SamosAT).
SNOWSHED_INLINE PackVec mixed(const View& s, const PackVec& u, const PackVec& around,
                              const PackVec& normal, const Pack& mass, const Pack& thickness) {
  const PackVec v = around - dot(around, normal) * normal, apart = v - u;
  const Pack side_per_mass = 2.0 * length_from(Pack(thickness / (s.density * mass)));
  const Pack rate = s.viscosity * 0.5 * s.density * length_from(dot(apart, apart)) * side_per_mass;
  const Pack f = s.time_step * rate;
  return Pack(1.0 / (1.0 + f)) * (u + f * v);
}

/// Velocities mixed with those of the snow around, and the places to which they lead without
/// forces.
struct PackAhead {
  PackVec velocity, place;
  PackReprojection on_ground;
  PackGround ground;
};

SNOWSHED_INLINE void mix(const View& s, const Lanes& l, PackAhead& ahead) {
  const Pack thickness = l.load(s.thickness);
  const Pack h = max(thickness, broadcast<Pack>(min_thickness));
  const PackRecord flow = flow_at(s, stored_place(s, l));
  const PackVec u = mixed(s, l.load(s.ux, s.uy, s.uz), {flow.b, flow.c, flow.d},
                          l.load(s.nx, s.ny, s.nz), l.load(s.mass), h);
  ahead.velocity = u;
  ahead.place = l.load(s.x, s.y, s.z) + broadcast<Pack>(s.time_step) * u;
  l.store(s.speed, length_from(dot(u, u)));
  l.store(s.ux, s.uy, s.uz, u);
  l.store_records(s.predicted, {ahead.place.x, ahead.place.y, ahead.place.z, thickness});
}

/// Weight and friction, with the mean of the ground's normals at both ends of the path.
SNOWSHED_INLINE void load_ground(const View& s, const Lanes& l, const PackAhead& ahead) {
  const PackVec here = l.load(s.nx, s.ny, s.nz);
  const PackMask stays = ahead.on_ground.on_ground.inside & ahead.ground.known;
  const PackVec end = select(stays, ahead.ground.normal, here), sum = here + end;
  const PackVec mean = inverse_sqrt(dot(sum, sum)) * sum;
  const Pack curvature = dot(ahead.velocity, end - here) * (1 / s.time_step);
  const Pack along_normal = -s.gravity * mean.z;
  // Friction does not act on snow that leaves the ground.
  const Pack pressing = max(Pack{}, Pack(-(along_normal + curvature)));  // m/s2
  const Pack h = max(l.load(s.thickness), broadcast<Pack>(min_thickness));
  const Pack drag = select(pressing > 0.0, Pack(s.friction_drag / (s.density * h)), Pack{});

  PackVec acceleration = Pack(-along_normal) * mean;
  acceleration.z -= s.gravity;
  l.store(s.ax, s.ay, s.az, acceleration);
  l.store(s.yield, s.friction * pressing);
  l.store(s.drag, drag);
}

SNOWSHED_INLINE void ground_batch(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end,
                                  int packs) {
  PackAhead ahead[packs_in_batch];
  for (int k = 0; k < packs; ++k) mix(s, lanes_of(begin, end, k), ahead[k]);
  for (int k = 0; k < packs; ++k) {
    const PackVec& x = ahead[k].place;
    ahead[k].on_ground = reproject(s, x.x, x.y, x.z, all_lanes);
  }
  for (int k = 0; k < packs; ++k) ahead[k].ground = ground_at(s, ahead[k].on_ground.on_ground);
  for (int k = 0; k < packs; ++k) load_ground(s, lanes_of(begin, end, k), ahead[k]);
}

SNOWSHED_MODULE_VARIANT_END
