#include "snowshed/methods/mps/wall_friction.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/elastic_strain.hpp"
#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// Lower limit of the wall distance that enters wall friction, in l0.
constexpr double min_friction_distance = 0.25;

/// Weight of a wall particle's friction on a particle that touches its obstacle, m; 0 if the wall
/// particle is not in the layer at the surface.
template <int D>
double friction_weight(const Model<D>& model, float weight, const VecD<D>& to_wall,
                       const WallContact<D>& c) {
  const double below = -to_wall.dot(c.normal);
  const bool at_surface = below - c.distance < model.settings().spacing;
  return at_surface ? double(weight) * std::max(0.0, below) : 0.0;
}

/// Sum of these weights over the particles that touch a wall particle's obstacle, but at least
/// `min_touched_share` times the sum on a lattice, so that a wall particle at the edge of the snow
/// has less friction.
template <int D>
double friction_weight_sum(const Model<D>& model, const Particles<D>& particles,
                           const Neighbourhood<D>& near, std::size_t wall) {
  double sum = 0;
  for (std::uint32_t e = near.lists.begin(wall); e < near.lists.end(wall); ++e) {
    const std::size_t i = near.lists.neighbour(e);
    const WallContact<D>* c =
        particles.is_wall(i) ? nullptr : near.contact_with(i, particles.event[wall]);
    if (c) sum += friction_weight(model, near.weight[e], VecD<D>(-near.separation(e)), *c);
  }
  constexpr double min_touched_share = 0.8;
  const double on_lattice =
      (1 - model.second_layer) / (model.laplacian() * model.settings().spacing);
  return std::max(sum, min_touched_share * on_lattice);
}

/// Finds the drag of a wall on a particle, 1/s, and the largest elastic slip of the particle. The
/// wall's shear stress is that of snow with the shear rate u/h at the pressure on the wall; u is
/// the speed at which the particle slides, and h is its distance from the wall. The stress acts on
/// the particles next to the wall. If the obstacle is not sticky, the stress is at most the
/// obstacle's own friction.
template <int D>
void find_drag(const Model<D>& model, double dt, const Particles<D>& particles, std::size_t i,
               const WallContact<D>& c, std::size_t k, WallFriction& walls) {
  walls.drag[k] = walls.yield_slip[k] = 0;
  if (walls.share[k] == 0) return;
  const Settings& s = model.settings();
  const Rheology& law = model.rheology;
  const ContactLaw& contact = model.options.obstacles[c.obstacle].law;
  const double height = std::max(c.distance, min_friction_distance * s.spacing);
  const double pressure = pressure_at_wall(model, particles, i, c, walls.reaction[k]);
  const double rate =
      sliding_velocity(model, dt, particles.velocity[i], particles.elastic_slip[i], c).norm() /
      height;
  const double friction =
      contact.condition == Condition::sticky ? HUGE_VAL : contact.friction * pressure;
  const double yield = std::min(law.yield_stress(pressure), friction);
  const double yield_rate = model.yield_rate(yield, dt);
  double viscosity = 0;
  if (model.is_elastic())
    viscosity = std::min(law.elastic_viscosity(yield, rate, yield_rate),
                         friction / std::max({rate, yield_rate, 1e-300}));
  else
    viscosity = std::min(law.apparent_viscosity(law.yield_stress(pressure), rate),
                         law.regularised(friction, rate));
  walls.drag[k] = walls.share[k] * viscosity / (s.density * s.spacing * height);
  walls.yield_slip[k] = yield_rate * dt * height;
}

/// A wall holds the snow that it presses with this many times the inertia of a particle.
constexpr double wall_hold = 1e4;

/// Walls bear the stress of the snow that they press: viscosity does not move its layer next to a
/// wall along the normal. The pressure has no share in this step, and would leave the snow without
/// a support.
template <int D>
double hold_of_wall(const Model<D>& model, const Particles<D>& particles, std::size_t i,
                    const WallContact<D>& c) {
  if (!model.is_elastic() || !(particles.pressure[i] > 0)) return 0;
  return wall_hold * share_of_wall(c.distance / model.settings().spacing, 0);
}

/// The velocity at which a wall holds a particle: the wall's if the snow is at rest there, so that
/// small errors of the pressure do not move it, and that before viscosity acts if the snow flows.
template <int D>
const VecD<D>& held_velocity(const Model<D>& model, double dt, const Workspace<D>& work,
                             const AlignedVector<VecD<D>>& start, std::size_t i,
                             const WallContact<D>& c) {
  return rests(model, dt, VecD<D>(work.before[i] - c.velocity)) ? c.velocity : start[i];
}

}  // namespace

template <int D>
void compute_wall_contact_fractions(const Model<D>& model, const Particles<D>& particles,
                                    Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const int threads = model.threads_for(particles.size());
  work.wall_friction.share.resize(near.contacts.all().size());
  work.wall_friction.drag.resize(near.contacts.all().size());
  work.wall_friction.yield_slip.resize(near.contacts.all().size());
  work.wall_friction.reaction.assign(near.contacts.all().size(), 0.0);
  if (!model.has_wall_particles()) {
    for (std::size_t k = 0; k < work.wall_friction.share.size(); ++k)
      work.wall_friction.share[k] = share_of_wall(
          near.contacts.all()[k].distance / model.settings().spacing, model.second_layer);
    return;
  }
  work.wall_friction.weight_sum.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t j) {
    if (particles.is_wall(j))
      work.wall_friction.weight_sum[j] = friction_weight_sum(model, particles, near, j);
  });
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
      double sum = 0;
      for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
        const std::size_t j = near.lists.neighbour(e);
        if (particles.is_wall(j) && particles.event[j] == c->obstacle)
          sum += friction_weight(model, near.weight[e], near.separation(e), *c) /
                 work.wall_friction.weight_sum[j];
      }
      work.wall_friction.share[near.contacts.index_of(c)] = sum;
    }
  });
}

template <int D>
void add_wall_action(const Model<D>& model, double dt, const AlignedVector<VecD<D>>& start,
                     const Particles<D>& particles, std::size_t i, Workspace<D>& work,
                     WallAction<D>& action) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const RowLists<WallContact<D>>& contacts = work.near.contacts;
  for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
    const std::size_t k = contacts.index_of(c);
    find_drag(model, dt, particles, i, *c, k, work.wall_friction);
    const double drag = work.wall_friction.drag[k];
    const Matrix normal = c->normal * c->normal.transpose();
    const Matrix along = dt * drag * (Matrix::Identity() - normal);
    const Matrix across = hold_of_wall(model, particles, i, *c) * normal;
    action.matrix += along + across;
    action.right_side +=
        along * c->velocity + across * held_velocity(model, dt, work, start, i, *c);
    if (model.is_elastic()) action.right_side -= along * particles.elastic_slip[i] / dt;
  }
}

template <int D>
void find_wall_reactions(const Model<D>& model, double dt, const AlignedVector<VecD<D>>& start,
                         const Particles<D>& particles, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const double per_speed = model.settings().density * model.settings().spacing / dt;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
      const std::size_t k = near.contacts.index_of(c);
      const double share = work.wall_friction.share[k];
      const double hold =
          particles.moves(i) && share > 0 ? hold_of_wall(model, particles, i, *c) : 0.0;
      const VecD<D>& held = held_velocity(model, dt, work, start, i, *c);
      work.wall_friction.reaction[k] =
          hold > 0 ? per_speed * hold / share * (held - particles.velocity[i]).dot(c->normal) : 0.0;
    }
  });
}

template void compute_wall_contact_fractions(const Model<2>&, const Particles<2>&, Workspace<2>&);
template void add_wall_action(const Model<2>&, double, const AlignedVector<VecD<2>>&,
                              const Particles<2>&, std::size_t, Workspace<2>&, WallAction<2>&);
template void find_wall_reactions(const Model<2>&, double, const AlignedVector<VecD<2>>&,
                                  const Particles<2>&, Workspace<2>&);
template void compute_wall_contact_fractions(const Model<3>&, const Particles<3>&, Workspace<3>&);
template void add_wall_action(const Model<3>&, double, const AlignedVector<VecD<3>>&,
                              const Particles<3>&, std::size_t, Workspace<3>&, WallAction<3>&);
template void find_wall_reactions(const Model<3>&, double, const AlignedVector<VecD<3>>&,
                                  const Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
