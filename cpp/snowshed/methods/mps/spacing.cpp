// What keeps particles apart besides the pressure.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed {
namespace {
static const double SH=getenv("SH")?atof(getenv("SH")):1, CL=getenv("CL")?atof(getenv("CL")):0, CR=getenv("CR")?atof(getenv("CR")):0;

/// Particles nearer to each other than this, in l0, bounce; so much of their speed is left (both as
/// is common in MPS codes).
constexpr double collision_distance = 0.5, restitution = 0.2;

/// Shift over the gradient of the concentration, in l0^2 (Lind and others 2012,
/// doi:10.1016/j.jcp.2011.10.027, where the same is half the square of the smoothing length).
constexpr double shift_factor = 0.05;

template <int D>
void collide(const MpsModel<D>& model, double distance_limit, double restitution, MpsParticles<D>& particles, MpsWork<D>& work) {
  const MpsNeighbourhood<D>& near = work.near;
  const double limit = distance_limit * model.settings().spacing;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.change[i].setZero();
    if (!particles.moves(i)) return;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const VecD<D> r = near.way(e);
      const double distance = r.norm();
      if (!(distance < limit) || distance == 0) continue;
      const std::size_t j = near.lists.neighbour(e);
      const double approach = (particles.velocity[i] - particles.velocity[j]).dot(r) / distance;
      const double share = particles.moves(j) ? 0.5 : 1.0;
      if (approach > 0) work.change[i] -= share * (1 + restitution) * approach / distance * r;
    }
  });
  for_each_particle(particles.size(), model.threads_for(particles.size()),
                    [&](std::size_t i) { particles.velocity[i] += work.change[i]; });
}

/// Towards where there are fewer particles; only within the snow.
template <int D>
void shift(const MpsModel<D>& model, double dt, MpsParticles<D>& particles, MpsWork<D>& work) {
  const MpsNeighbourhood<D>& near = work.near;
  const double l0 = model.settings().spacing;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.change[i].setZero();
    if (!particles.moves(i) || near.below_surface[i]) return;
    VecD<D> gradient = VecD<D>::Zero();
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      gradient += double(near.slope[e]) * near.way(e);
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
      gradient += double(m->slope) * m->way;
    gradient *= model.gradient();
    const double travelled = (particles.velocity[i].norm() + SH*std::sqrt(model.gravity.norm() * l0)) * dt / l0;
    VecD<D> way = -shift_factor * std::min(1.0, 10 * travelled) * l0 * l0 * gradient;
    const double most = 0.05 * l0;
    if (way.norm() > most) way *= most / way.norm();
    work.change[i] = way;
  });
  for_each_particle(particles.size(), model.threads_for(particles.size()),
                    [&](std::size_t i) { particles.position[i] += work.change[i]; });
}

}  // namespace

template <int D>
void keep_spacing(const MpsModel<D>& model, double dt, MpsParticles<D>& particles,
                  MpsWork<D>& work) {
  if (model.settings().spacing_law == MpsSpacing::collision) collide(model, collision_distance, restitution, particles, work);
  if (model.settings().spacing_law == MpsSpacing::shifting && CL>0) collide(model, CL, CR, particles, work);
  if (model.settings().spacing_law == MpsSpacing::shifting) shift(model, dt, particles, work);
}

template void keep_spacing(const MpsModel<2>&, double, MpsParticles<2>&, MpsWork<2>&);
template void keep_spacing(const MpsModel<3>&, double, MpsParticles<3>&, MpsWork<3>&);

}  // namespace snowshed
