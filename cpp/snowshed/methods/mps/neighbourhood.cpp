// Neighbours, number densities and the free surface.
#include <Eigen/LU>
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
/// Of the matrix of a particle's neighbours, below which gradients are not corrected; 1 on a
/// lattice, 0.4 at its surface.
constexpr double least_determinant = 0.1;

template <int D>
void sort_particles(const CellOrder<D>& cells, MpsParticles<D>& particles, MpsParticles<D>& spare,
                    int threads) {
  if (cells.is_sorted()) return;
  const std::size_t n = particles.size();
  spare.resize(n);
  const std::vector<std::uint32_t>& order = cells.order();
  MpsParticles<D>::visit_arrays(particles, spare, [&](const char*, const auto& from, auto& to) {
    for_each_particle(n, threads, [&](std::size_t k) { to[k] = from[order[k]]; });
  });
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
  near.below_surface.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    bool below = near.surface[i];
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i) && !below; ++e)
      below = near.surface[near.lists.neighbour(e)];
    near.below_surface[i] = below;
  });
}

/// The inverse of d/n0 sum of w r r^T/r^2 over neighbours and walls, with which gradients are right
/// for linear fields however the neighbours lie (Randles and Libersky 1996,
/// doi:10.1016/S0045-7825(96)01090-0; in MPS Khayyer and Gotoh 2011,
/// doi:10.1016/j.jcp.2011.01.009). On a lattice it is the identity, and so it is where too few
/// neighbours are left. `spread` is a first-order correction (ours) of weights by e.B e, e the
/// direction of a pair, that makes the sum of w r r^T, and with it Laplacians of quadratic fields,
/// that of a lattice.
template <int D>
void find_corrections(const MpsModel<D>& model, MpsNeighbourhood<D>& near, int threads) {
  using Matrix = Eigen::Matrix<double, D, D>;
  near.correction.resize(near.lists.size());
  near.asymmetry.resize(near.lists.size());
  near.spread.resize(near.lists.size());
  for_each_particle(near.lists.size(), threads, [&](std::size_t i) {
    Matrix moment = Matrix::Zero(), second = Matrix::Zero();
    VecD<D> side = VecD<D>::Zero();
    const auto add = [&](const VecD<D>& r, double weight, double slope) {
      moment += slope * r * r.transpose();
      second += weight * r * r.transpose();
      side += weight * r;
    };
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      add(near.way(e), double(near.weight[e]), double(near.slope[e]));
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
      add(m->way, double(m->weight), double(m->slope));
    const Matrix missing = Matrix::Identity() - 0.5 * model.laplacian() * second;
    near.spread[i] = Matrix::Identity();
    if (!near.below_surface[i])
      near.spread[i] += 0.5 * ((D + 2) * missing - missing.trace() * Matrix::Identity());
    near.asymmetry[i] = near.below_surface[i] ? VecD<D>(VecD<D>::Zero()) : side;
    moment *= model.gradient();
    near.correction[i] = moment.determinant() > least_determinant ? Matrix(moment.inverse())
                                                                  : Matrix(Matrix::Identity());
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
  if (model.settings().gradient == MpsGradient::corrected) find_corrections(model, near, threads);
}

template void find_neighbours(const MpsModel<2>&, MpsParticles<2>&, double, MpsWork<2>&);
template void find_neighbours(const MpsModel<3>&, MpsParticles<3>&, double, MpsWork<3>&);

}  // namespace snowshed
