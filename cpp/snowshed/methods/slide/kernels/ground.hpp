// How the ground acts on snow: weight, friction, curvature.
#pragma once

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_VARIANT_BEGIN

/// Draws a velocity toward that of the snow around, implicitly (artificial viscosity of SamosAT).
SNOWSHED_INLINE PackVec mixed(const SlideView& s, const PackVec& u, const PackVec& around,
                              const PackVec& normal, const Pack& mass, const Pack& thickness) {
  const PackVec v = around - dot(around, normal) * normal, apart = v - u;
  const Pack side_per_mass = 2.0 * length_from(Pack(thickness / (s.density * mass)));
  const Pack rate = s.viscosity * 0.5 * s.density * length_from(dot(apart, apart)) * side_per_mass;
  const Pack f = s.time_step * rate;
  return Pack(1.0 / (1.0 + f)) * (u + f * v);
}

/// The ground's normal where a particle would be without forces at the end of the step.
SNOWSHED_INLINE PackVec normal_ahead(const SlideView& s, const PackVec& ahead,
                                     const PackVec& here) {
  const PackReprojection r = reproject(s, ahead.x, ahead.y, ahead.z);
  const PackGround ground = ground_at(s, r.on_ground);
  return select(PackMask(r.on_ground.inside & ground.known), ground.normal, here);
}

SNOWSHED_INLINE void ground_lanes(const SlideView& s, const Lanes& l) {
  const PackPlace place = stored_place(s, l);
  const PackVec here = l.load(s.nx, s.ny, s.nz), x = l.load(s.x, s.y, s.z);
  const Pack thickness = l.load(s.thickness);
  const Pack h = max(thickness, broadcast<Pack>(least_slide_thickness));
  const PackRecord flow = flow_at(s, place);
  const PackVec u =
      mixed(s, l.load(s.ux, s.uy, s.uz), {flow.b, flow.c, flow.d}, here, l.load(s.mass), h);

  const PackVec ahead = x + broadcast<Pack>(s.time_step) * u;
  const PackVec end = normal_ahead(s, ahead, here), sum = here + end;
  const PackVec mean = inverse_sqrt(dot(sum, sum)) * sum;
  const Pack curvature = dot(u, end - here) * (1 / s.time_step);
  const Pack along_normal = -s.gravity * mean.z;
  // Snow that leaves the ground is not held back by it.
  const Pack pressing = max(Pack{}, Pack(-(along_normal + curvature)));  // m/s2
  const Pack drag = select(pressing > 0.0, Pack(s.friction_drag / (s.density * h)), Pack{});

  PackVec acceleration = Pack(-along_normal) * mean;
  acceleration.z -= s.gravity;
  l.store(s.ax, s.ay, s.az, acceleration);
  l.store(s.yield, s.friction * pressing);
  l.store(s.drag, drag);
  l.store(s.speed, length_from(dot(u, u)));
  l.store(s.ux, s.uy, s.uz, u);
  Quad rows[pack_lanes];
  put_together({ahead.x, ahead.y, ahead.z, thickness}, rows);
  for (int i = 0; i < l.count; ++i) store_row(s.predicted + 4 * (l.first + i), rows[i]);
}

SNOWSHED_VARIANT_END
