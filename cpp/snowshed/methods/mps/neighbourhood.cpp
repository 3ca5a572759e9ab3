// Neighbours, number densities and the free surface.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed {
namespace {

/// Particles that see the fluid on all sides are within it, however low their density: the sum of
/// w r/r over the neighbours and walls, over n0 (after Khayyer and others 2009). On a lattice it is
/// 0.28 at a plane surface in 2D, and 0.26 in 3D.
constexpr double least_asymmetry = 0.12;
/// Below this ratio of number densities a particle is at a surface whatever is around it.
constexpr double sparse = 0.75;

template <int D>
void sort_particles(const CellOrder<D>& cells, MpsParticles<D>& particles, MpsParticles<D>& spare,
                    int threads) {
  if (cells.is_sorted()) return;
  const std::size_t n = particles.size();
  spare.resize(n);
  const std::vector<std::uint32_t>& order = cells.order();
  const auto gather = [&](const auto& from, auto& to) {
    for_each_particle(n, threads, [&](std::size_t k) { to[k] = from[order[k]]; });
  };
  gather(particles.position, spare.position);
  gather(particles.velocity, spare.velocity);
  gather(particles.pressure, spare.pressure);
  gather(particles.mass, spare.mass);
  gather(particles.density, spare.density);
  gather(particles.rate, spare.rate);
  gather(particles.viscosity, spare.viscosity);
  gather(particles.support, spare.support);
  gather(particles.kind, spare.kind);
  gather(particles.id, spare.id);
  gather(particles.event, spare.event);
  std::swap(particles, spare);
}

template <int D>
void weigh_pairs(const MpsModel<D>& model, MpsNeighbourhood<D>& near, int threads) {
  const float reach = float(model.reach());
  near.weight.resize(near.lists.pairs());
  near.slope.resize(near.lists.pairs());
  for_each_particle(near.lists.size(), threads, [&](std::size_t i) {
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      float r2 = 0;
      for (int d = 0; d < D; ++d) r2 += near.lists.offset(d)[e] * near.lists.offset(d)[e];
      r2 = std::max(r2, 1e-4f * reach * reach);  // particles in the same place
      const float w = std::max(reach / std::sqrt(r2) - 1, 0.0f);
      near.weight[e] = w;
      near.slope[e] = w / r2;
    }
  });
}

/// Equation (7), with the images of the neighbours, and equation (19).
template <int D>
void find_surface(const MpsModel<D>& model, const MpsParticles<D>& particles,
                  MpsNeighbourhood<D>& near, int threads) {
  const double n0 = model.kernel.number_density, ratio = model.settings().surface_ratio;
  const bool published = model.settings().surface == MpsSurface::published;
  near.density.resize(particles.size());
  near.surface.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    float sum = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) sum += near.weight[e];
    double n = double(sum);
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
      n += double(m->weight);
    near.density[i] = n;
    bool surface = !particles.is_wall(i) && n < ratio * n0;
    if (surface && !published && n >= sparse * n0) {
      VecD<D> side = VecD<D>::Zero();
      for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
        side += double(near.weight[e]) * near.way(e).stableNormalized();
      for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
        side += double(m->weight) * m->way.stableNormalized();
      surface = side.norm() > least_asymmetry * n0;
    }
    near.surface[i] = surface;
  });
}

}  // namespace

template <int D>
void find_neighbours(const MpsModel<D>& model, MpsParticles<D>& particles, double time,
                     MpsWork<D>& work) {
  MpsNeighbourhood<D>& near = work.near;
  const int threads = model.threads_for(particles.size());
  const double reach = model.reach(), period = model.options.period;
  near.cells.update(particles.position, reach, period);
  if (!near.cells.is_sorted()) {
    sort_particles(near.cells, particles, work.spare, threads);
    near.cells.update(particles.position, reach, period);
  }
  near.lists.update(particles.position, near.cells, reach, period, threads);
  find_contacts(model.options.obstacles, reach, particles.position, time, threads, near.contacts);
  weigh_pairs(model, near, threads);
  near.images.update(near.lists, near.contacts, reach, model.settings().spacing, threads,
                     near.weight, near.coupling);
  find_surface(model, particles, near, threads);
}

template void find_neighbours(const MpsModel<2>&, MpsParticles<2>&, double, MpsWork<2>&);
template void find_neighbours(const MpsModel<3>&, MpsParticles<3>&, double, MpsWork<3>&);

}  // namespace snowshed
