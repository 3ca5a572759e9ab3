#include "snowshed/methods/grains/forces.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/grains/contacts.hpp"

namespace snowshed::methods::grains {
namespace {

constexpr std::ptrdiff_t groups_in_piece = 16, bodies_in_piece = 32;

BodyFrame frame_of(const GrainBody& body, const Vec3& inertia) {
  const Mat3 rotation = body.orientation.toRotationMatrix();
  const Vec3 spin = angular_velocity(rotation, body.spin_momentum, inertia);
  BodyFrame f;
  for (int i = 0; i < 3; ++i) {
    f.position[i] = body.position[i];
    f.velocity[i] = body.velocity[i];
    f.spin[i] = spin[i];
    for (int j = 0; j < 3; ++j) f.rotation[3 * i + j] = rotation(i, j);
  }
  return f;
}

BodyFrame frame_of_plate(const Boundary& b, int plate) {
  BodyFrame f{};
  for (int i = 0; i < 3; ++i) {
    f.position[i] = b.plate[plate][i];
    f.velocity[i] = b.plate_velocity[plate][i];
    f.rotation[4 * i] = 1;
  }
  return f;
}

View view_of(const Model& model, State& state, Workspace& work, double dt) {
  PairList& l = state.pairs;
  View v{};
  v.bodies = work.frames.data();
  v.groups = l.groups.data();
  v.ax = l.ax.data();
  v.ay = l.ay.data();
  v.az = l.az.data();
  v.bx = l.bx.data();
  v.by = l.by.data();
  v.bz = l.bz.data();
  v.ux = l.ux.data();
  v.uy = l.uy.data();
  v.uz = l.uz.data();
  v.bonded = l.bonded.data();
  v.results = work.results.data();
  v.diameter = 2 * model.radius;
  v.time_step = dt;
  for (int axis = 0; axis < 2; ++axis) {
    v.period[axis] = state.boundary.period(axis);
    v.period_growth[axis] = state.boundary.period_growth(axis);
  }
  v.normal_stiffness = model.law.normal_stiffness;
  v.shear_stiffness = model.law.shear_stiffness;
  v.tension_limit = model.law.tension_limit;
  v.shear_limit = model.law.shear_limit;
  v.friction = model.law.friction;
  return v;
}

SimdVec<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec(const SimdVec<double>& t) { return {t.x, t.y, t.z}; }
Vec3 vec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

Vec3 surface_velocity(const Boundary& b, Partner partner) {
  if (partner == Partner::cone) return b.tip_velocity;
  const int side = int(partner) - int(Partner::west);
  return b.side_velocity[side] * Vec3::Unit(side / 2);
}

/// Finds the forces of a wall, without friction, or of the cone on the spheres of a grain.
void surface_forces(const Model& model, State& state, Workspace& work, std::size_t group,
                    double dt) {
  const PairGroup& g = state.pairs.groups[group];
  const Partner partner = Partner(g.second - std::uint32_t(model.grains.size()));
  const double rough = partner == Partner::cone ? 1 : 0;  // sides do not take shear
  const GrainBody& body = state.bodies[g.first];
  const Vec3 spin = vec(work.frames[g.first].spin);
  const Mat3 rotation = body.orientation.toRotationMatrix();
  const Vec3 surface = surface_velocity(state.boundary, partner);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  GroupForce r{};
  PairList& list = state.pairs;
  for (std::size_t p = g.begin; p < g.end; ++p) {
    if (!list.is_pair(p)) continue;
    const PairGeometry pair =
        pair_geometry(model, state.boundary, list, g, p, body.position, rotation, nullptr);
    if (pair.gap >= 0 && list.shear(p).isZero(0.0)) continue;
    const Vec3 velocity = surface - body.velocity - spin.cross(pair.arm_a);
    const double along = velocity.dot(pair.normal);
    const ContactMotion<double> motion{pair.gap, dt * along, triple(pair.normal),
                                       triple(rough * dt * (velocity - along * pair.normal)),
                                       0.5 * dt * spin.dot(pair.normal)};
    SimdVec<double> u{list.ux[p], list.uy[p], list.uz[p]};
    bool bonded = false;
    const auto f = model.law(motion, u, bonded);
    list.ux[p] = u.x;
    list.uy[p] = u.y;
    list.uz[p] = u.z;
    const Vec3 on_grain = vec(f.shear_force) - f.normal_force * pair.normal;
    force += on_grain;
    torque += pair.arm_a.cross(on_grain);
    r.heat += f.heat;
    r.touching += f.touching;
  }
  for (int i = 0; i < 3; ++i) {
    r.force[i] = force[i];
    r.torque_on_first[i] = torque[i];
  }
  work.results[group] = r;
}

/// Local damping (Cundall 1987): each component of force and torque is reduced by a share of itself
/// if it accelerates the grain, and increased by the share if it slows the grain down. Returns the
/// damping force.
Vec3 damping_of(double share, const Vec3& force, const Vec3& velocity) {
  Vec3 damping;
  for (int i = 0; i < 3; ++i) {
    const double power = force[i] * velocity[i];
    damping[i] = power == 0 ? 0.0 : -share * std::copysign(std::abs(force[i]), velocity[i]);
  }
  return damping;
}

/// Adds up the forces of the groups on a grain, in their order.
void gather(const Model& model, State& state, const Workspace& work, std::size_t i) {
  GrainBody& body = state.bodies[i];
  body.force = Vec3(0, 0, -model.grains[i].weight);
  body.torque.setZero();
  for (std::uint32_t e = work.groups_by_body.begin[i]; e < work.groups_by_body.begin[i + 1]; ++e) {
    const std::uint32_t entry = work.groups_by_body.entry[e];
    const GroupForce& f = work.results[entry >> 1];
    const bool second = (entry & 1) != 0;
    body.force += (second ? -1.0 : 1.0) * vec(f.force);
    body.torque += second ? vec(f.torque_on_second) : vec(f.torque_on_first);
  }
  const double share = model.settings.damping;
  body.damping = damping_of(share, body.force, body.velocity);
  body.spin_damping = damping_of(share, body.torque, vec(work.frames[i].spin));
  body.force += body.damping;
  body.torque += body.spin_damping;
}

/// Sums the forces on plates, sides and the cone, and the losses, group by group.
void sum_up(const Model& model, State& state, const Workspace& work) {
  Boundary& b = state.boundary;
  for (Vec3* f : {&b.plate_force[0], &b.plate_force[1], &b.cone_force}) f->setZero();
  for (double& f : b.side_force) f = 0;
  b.top_contacts = 0;
  for (std::size_t i = 0; i < state.pairs.groups.size(); ++i) {
    const PairGroup& g = state.pairs.groups[i];
    const GroupForce& f = work.results[i];
    state.energy.friction += f.heat;
    state.energy.broken += f.broken_energy;
    state.broken_in_tension += f.tension_breaks;
    state.broken_in_shear += f.shear_breaks;
    state.bonds -= f.tension_breaks + f.shear_breaks;
    for (int axis = 0; axis < 2; ++axis)
      for (int side = 0; side < 2; ++side)
        b.side_force[2 * axis + side] -= g.shift[axis] * f.force[axis];
    if (g.second < model.grains.size()) continue;
    const Partner partner = Partner(g.second - std::uint32_t(model.grains.size()));
    if (partner == Partner::bottom_plate) {
      b.plate_force[0] -= vec(f.force);
    } else if (partner == Partner::top_plate) {
      b.plate_force[1] -= vec(f.force);
      b.top_contacts += f.touching;
    } else if (partner == Partner::cone) {
      b.cone_force -= vec(f.force);
    } else {
      const int side = int(partner) - int(Partner::west);
      b.side_force[side] += (side % 2 == 0 ? 1 : -1) * f.force[side / 2];
    }
  }
}

}  // namespace

void evaluate_forces(const Model& model, State& state, Workspace& work, double dt) {
  const std::size_t grains = state.bodies.size();
  const int threads = model.threads_for(state.pairs.size());
  parallel_pieces(std::ptrdiff_t(grains), threads, bodies_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t i = begin; i < end; ++i)
                      work.frames[std::size_t(i)] = frame_of(state.bodies[std::size_t(i)],
                                                             model.grains[std::size_t(i)].inertia);
                  });
  for (int plate = 0; plate < 2; ++plate)
    work.frames[grains + std::size_t(plate)] = frame_of_plate(state.boundary, plate);
  const View view = view_of(model, state, work, dt);
  const Kernels& kernels = chosen_kernels();
  const std::size_t first_surface = grains + std::size_t(Partner::west);
  parallel_pieces(std::ptrdiff_t(state.pairs.groups.size()), threads, groups_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::size_t g = std::size_t(begin); g < std::size_t(end); ++g)
                      if (state.pairs.groups[g].second < first_surface)
                        kernels.pair_forces(view, g);
                      else
                        surface_forces(model, state, work, g, dt);
                  });
  parallel_pieces(std::ptrdiff_t(grains), threads, bodies_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t i = begin; i < end; ++i)
                      gather(model, state, work, std::size_t(i));
                  });
  sum_up(model, state, work);
}

}  // namespace snowshed::methods::grains
