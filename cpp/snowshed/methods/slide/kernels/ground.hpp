// How the ground acts on snow: weight, friction, curvature.
#pragma once

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_VARIANT_BEGIN

/// Draws a velocity toward that of the snow around, implicitly (artificial viscosity of SamosAT).
SNOWSHED_INLINE QuadVec mixed(const SlideView& s, const QuadVec& u, const QuadVec& around,
                              const QuadVec& normal, const Quad& mass, const Quad& thickness) {
  const QuadVec v = around - dot(around, normal) * normal, apart = v - u;
  const Quad side_per_mass = 2.0 * length_from(Quad(thickness / (s.density * mass)));
  const Quad rate = s.viscosity * 0.5 * s.density * length_from(dot(apart, apart)) * side_per_mass;
  const Quad f = s.time_step * rate;
  return Quad(1.0 / (1.0 + f)) * (u + f * v);
}

/// The ground's normal where a particle would be without forces at the end of the step.
SNOWSHED_INLINE QuadVec normal_ahead(const SlideView& s, const QuadVec& ahead,
                                     const QuadVec& here) {
  const QuadReprojection r = reproject(s, ahead.x, ahead.y, ahead.z);
  const QuadRecord ground = interpolated(s.ground, s.columns, r.on_ground);
  return select(QuadMask(r.on_ground.inside & is_known(s, r.on_ground)), upward(ground.b, ground.c),
                here);
}

SNOWSHED_INLINE void ground_lanes(const SlideView& s, const Lanes& l) {
  const QuadPlace place = stored_place(s, l);
  const QuadVec here = l.load(s.nx, s.ny, s.nz), x = l.load(s.x, s.y, s.z);
  const Quad thickness = l.load(s.thickness);
  const Quad h = max(thickness, broadcast<Quad>(least_slide_thickness));
  const QuadRecord flow = flow_at(s, place);
  const QuadVec u =
      mixed(s, l.load(s.ux, s.uy, s.uz), {flow.b, flow.c, flow.d}, here, l.load(s.mass), h);

  const QuadVec ahead = x + broadcast<Quad>(s.time_step) * u;
  const QuadVec end = normal_ahead(s, ahead, here), sum = here + end;
  const QuadVec mean = inverse_sqrt(dot(sum, sum)) * sum;
  const Quad curvature = dot(u, end - here) * (1 / s.time_step);
  const Quad along_normal = -s.gravity * mean.z;
  // Snow that leaves the ground is not held back by it.
  const Quad pressing = max(Quad{}, Quad(-(along_normal + curvature)));  // m/s2
  const Quad drag = select(pressing > 0.0, Quad(s.friction_drag / (s.density * h)), Quad{});

  QuadVec acceleration = Quad(-along_normal) * mean;
  acceleration.z -= s.gravity;
  l.store(s.ax, s.ay, s.az, acceleration);
  l.store(s.yield, s.friction * pressing);
  l.store(s.drag, drag);
  l.store(s.speed, length_from(dot(u, u)));
  l.store(s.ux, s.uy, s.uz, u);
  Quad rows[4] = {ahead.x, ahead.y, ahead.z, thickness};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  for (int i = 0; i < l.count; ++i) store_row(s.predicted + 4 * (l.first + i), rows[i]);
}

SNOWSHED_VARIANT_END
