// Rules besides the pressure that keep particles apart.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// Particles nearer to each other than `distance` (in l0) bounce, and keep the share `restitution`
/// of the speed at which they approach. Wall particles may be left out.
struct Collision {
  double distance, restitution;
  bool with_walls;
};
/// The values that are common in MPS codes.
constexpr Collision common_collision{0.5, 0.2, true};
/// With shifting, particles nearer than the spacing of the lattice only stop approaching each other
/// (ours, after the dynamic stabilisation of Tsuruta and others 2013, Computers & Fluids 82):
/// velocities that alternate between neighbours have no divergence and would otherwise persist.
/// With a distance of 0.8 water at rest boils after 5 s. A row of wall particles would be rough at
/// this distance, and slow down snow that slides along it.
constexpr Collision inelastic_collision{1.0, 0.0, false};

/// Shift over the gradient of the concentration, in l0^2 (Lind and others 2012,
/// doi:10.1016/j.jcp.2011.10.027, where this factor is half the square of the smoothing length).
constexpr double shift_factor = 0.05;

template <int D>
void collide(const Model<D>& model, const Collision& law, Particles<D>& particles,
             Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  work.spacing.impulse_share.resize(n);
  work.change.resize(n);
  for_each_particle(n, threads, [&](std::size_t i) {
    const double fixed = particles.is_wall(i) && !law.with_walls ? 0.0 : 1.0;
    work.spacing.impulse_share[i] = particles.moves(i) ? 0.5 : fixed;
  });
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_approaches(
        near.rows(), near.offsets().data(), particles.velocity.data()->data(),
        work.spacing.impulse_share.data(), law.distance * model.settings().spacing,
        work.change.data()->data(), begin, end);
  });
  for_each_particle(n, threads, [&](std::size_t i) {
    if (particles.moves(i)) particles.velocity[i] -= (1 + law.restitution) * work.change[i];
  });
}

/// d/n0 times the sum of w r/r^2, which points from fewer to more particles, 1/m.
template <int D>
void find_concentration_gradients(const Model<D>& model, std::size_t n, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  work.spacing.concentration.resize(n);
  for_each_piece(n, model.threads_for(n), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_separations(near.rows(), near.offsets().data(), near.slope.data(), nullptr,
                                  nullptr, work.spacing.concentration.data()->data(), begin, end);
  });
  for_each_particle(n, model.threads_for(n), [&](std::size_t i) {
    VecD<D>& gradient = work.spacing.concentration[i];
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
      gradient += double(m->slope) * m->separation;
    gradient *= model.gradient();
  });
}

/// The direction into the snow at its surface: that of the weighted sum of the gradients of a
/// particle and of its neighbours.
template <int D>
VecD<D> inward(const AlignedVector<VecD<D>>& gradients, const Neighbourhood<D>& near,
               std::size_t i) {
  VecD<D> sum = gradients[i];
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
    if (near.below_surface[near.lists.neighbour(e)])
      sum += double(near.weight[e]) * gradients[near.lists.neighbour(e)];
  return sum.stableNormalized();
}

/// Shifts particles towards lower concentrations. Particles at the surface are shifted only along
/// it, and those below it not towards it, because the surface would rise. A fluid without a yield
/// stress is shifted at rest, too, as if it moved at the speed of a fall over l0, because the
/// corrected gradient does not keep its particles apart. Snow with a yield stress is not shifted at
/// rest: it would creep (ours).
template <int D>
void shift(const Model<D>& model, double dt, Particles<D>& particles, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const double l0 = model.settings().spacing;
  const double fall = std::sqrt(model.gravity.norm() * l0);
  const int threads = model.threads_for(particles.size());
  find_concentration_gradients(model, particles.size(), work);
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    work.change[i].setZero();
    if (!particles.moves(i) || rests(model, dt, particles.velocity[i])) return;
    VecD<D> gradient = work.spacing.concentration[i];
    if (near.below_surface[i]) {
      const VecD<D> normal = inward<D>(work.spacing.concentration, near, i);
      const double outwards = gradient.dot(normal);
      gradient -= (near.surface[i] ? outwards : std::max(outwards, 0.0)) * normal;
    }
    const double travelled = (particles.velocity[i].norm() + fall) * dt / l0;
    VecD<D> shift = -shift_factor * std::min(1.0, 10 * travelled) * l0 * l0 * gradient;
    const double max_shift = 0.05 * l0;
    if (shift.norm() > max_shift) shift *= max_shift / shift.norm();
    work.change[i] = shift;
  });
  for_each_particle(particles.size(), threads,
                    [&](std::size_t i) { particles.position[i] += work.change[i]; });
}

}  // namespace

template <int D>
void keep_spacing(const Model<D>& model, double dt, Particles<D>& particles, Workspace<D>& work) {
  switch (model.settings().spacing_law) {
    case SpacingLaw::none:
      return;
    case SpacingLaw::collision:
      return collide(model, common_collision, particles, work);
    case SpacingLaw::shifting:
      collide(model, inelastic_collision, particles, work);
      shift(model, dt, particles, work);
  }
}

template void keep_spacing(const Model<2>&, double, Particles<2>&, Workspace<2>&);
template void keep_spacing(const Model<3>&, double, Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
