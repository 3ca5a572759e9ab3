// Neighbours, number densities and the free surface.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"
#include "snowshed/methods/mps/moments.hpp"

namespace snowshed::methods::mps {
namespace {

/// Least asymmetry of a particle at the surface: the norm of the sum of w r/|r| over the neighbours
/// and walls, over n0 (after Khayyer and others 2009). A particle below it has fluid on all sides,
/// and is not at the surface even if its density is low. On a lattice the asymmetry is 0.28 at a
/// plane surface in 2D, and 0.26 in 3D.
constexpr double min_asymmetry = 0.12;
/// The same for inner walls; on a lattice it is 0.05 where the surface meets the wall.
constexpr double min_wall_asymmetry = 0.03;
/// Below this ratio of number densities a particle is at a surface with any asymmetry.
constexpr double sparse_density = 0.75;
/// Minimum determinant of the matrix of a particle's neighbours for which gradients are corrected;
/// it is 1 on a lattice, 0.4 at its surface.
constexpr double min_determinant = 0.1;

template <int D>
void sort_particles(const particles::CellOrder<D>& cells, Particles<D>& particles,
                    Particles<D>& spare, int threads) {
  if (cells.is_sorted()) return;
  const std::size_t n = particles.size();
  spare.resize(n);
  const std::vector<std::uint32_t>& order = cells.order();
  Particles<D>::visit_arrays(particles, spare, [&](const char*, const auto& from, auto& to) {
    for_each_particle(n, threads, [&](std::size_t k) { to[k] = from[order[k]]; });
  });
  std::swap(particles, spare);
}

template <int D>
void weigh_pairs(const Model<D>& model, Neighbourhood<D>& near, int threads) {
  near.weight.resize(near.lists.pairs());
  near.slope.resize(near.lists.pairs());
  near.weight_sum.resize(near.lists.size());
  near.filling_sum.resize(near.lists.size());
  for_each_piece(near.lists.size(), threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.weigh(near.rows(), near.offsets().data(), float(model.reach()),
                        near.weight.data(), near.slope.data(), near.weight_sum.data(),
                        near.filling_sum.data(), begin, end);
  });
}

/// A wall particle is at the surface only if snow beside it is. Otherwise disorder of the snow
/// beside a wall would release all pressure through the wall.
template <int D>
void leave_walls_within(const Particles<D>& particles, Neighbourhood<D>& near, int threads) {
  const auto is_snow_at_surface = [&](std::size_t j) {
    return !particles.is_wall(j) && near.surface[j];
  };
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    if (!near.surface[i] || !particles.is_wall(i)) return;
    bool beside = false;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i) && !beside; ++e)
      beside = is_snow_at_surface(near.lists.neighbour(e));
    near.surface[i] = beside;
  });
}

/// Number densities by equation (7), with the images of the neighbours, and the surface by equation
/// (19).
template <int D>
void find_surface(const Model<D>& model, const Particles<D>& particles, Neighbourhood<D>& near,
                  int threads) {
  const double n0 = model.kernel.number_density, ratio = model.settings().surface_ratio;
  const bool published = model.settings().surface == Surface::published;
  near.density.resize(particles.size());
  near.filling.resize(particles.size());
  near.surface.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    double n = double(near.weight_sum[i]), filling = 1 + double(near.filling_sum[i]);
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m) {
      n += double(m->weight);
      filling += filling_weight(double(m->weight));
    }
    near.density[i] = n;
    near.filling[i] = filling / model.kernel.filling;
    bool surface = particles.kind[i] != Kind::dummy_wall && n < ratio * n0;
    if (surface && !published && n >= sparse_density * n0) {
      VecD<D> side = VecD<D>::Zero();
      for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
        side += double(near.weight[e]) * near.separation(e).stableNormalized();
      for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m)
        side += double(m->weight) * m->separation.stableNormalized();
      surface = side.norm() > (particles.is_wall(i) ? min_wall_asymmetry : min_asymmetry) * n0;
    }
    near.surface[i] = surface;
  });
  if (model.has_wall_particles() && !published) leave_walls_within(particles, near, threads);
  near.below_surface.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    bool below = near.surface[i];
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i) && !below; ++e)
      below = near.surface[near.lists.neighbour(e)];
    near.below_surface[i] = below;
  });
}

/// `correction` is the inverse of d/n0 times the sum of w r r^T/r^2 over neighbours and walls. With
/// it gradients are exact for linear fields in any arrangement of the neighbours (Randles and
/// Libersky 1996, doi:10.1016/S0045-7825(96)01090-0; in MPS Khayyer and Gotoh 2011,
/// doi:10.1016/j.jcp.2011.01.009). It is the identity on a lattice, and if there are too few
/// neighbours. `weight_correction` is a matrix B. The factor e.B e of weights, with the direction e
/// of a pair, is a first-order correction (ours): the sum of w r r^T, and with it Laplacians of
/// quadratic fields, become those of a lattice. `asymmetry` is the sum of w r of snow and of inner
/// walls, whose pressure is solved. Dummy walls have no pressure, and are left out of gradients.
template <int D>
void find_corrections(const Model<D>& model, const Particles<D>& particles, Neighbourhood<D>& near,
                      int threads) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const std::size_t n = near.lists.size();
  near.correction.resize(n);
  near.asymmetry.resize(n);
  near.weight_correction.resize(n);
  near.moments.resize(n);
  const float* const slope = slope_without(Kind::dummy_wall, model, particles, near);
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_moments(near.rows(), near.offsets().data(), near.weight.data(), slope,
                              near.moments.data(), begin, end);
  });
  for_each_particle(n, threads, [&](std::size_t i) {
    near.asymmetry[i].setZero();
    near.weight_correction[i] = upper_half<D>(Matrix::Identity());
    near.correction[i].setIdentity();
    VecD<D> side;
    for (int d = 0; d < D; ++d) side[d] = double(near.moments[i].side[d]);
    if (particles.kind[i] == Kind::inner_wall && !near.below_surface[i]) near.asymmetry[i] = side;
    if (particles.is_wall(i)) return;
    Matrix moment = symmetric<D>(near.moments[i].slope);
    Matrix second = symmetric<D>(near.moments[i].weight);
    for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m) {
      moment += double(m->slope) * m->separation * m->separation.transpose();
      second += double(m->weight) * m->separation * m->separation.transpose();
      side += double(m->weight) * m->separation;
    }
    if (!near.below_surface[i]) {
      const Matrix missing = Matrix::Identity() - 0.5 * model.laplacian() * second;
      near.weight_correction[i] = upper_half<D>(
          Matrix::Identity() + 0.5 * ((D + 2) * missing - missing.trace() * Matrix::Identity()));
      near.asymmetry[i] = side;
    }
    moment *= model.gradient();
    if (moment.determinant() > min_determinant) near.correction[i] = moment.inverse();
  });
}

/// The weights of pairs in the Laplacians of velocities, see find_corrections.
template <int D>
void find_isotropic_weights(const Model<D>& model, Neighbourhood<D>& near, int threads) {
  near.isotropic_weight.resize(near.lists.pairs());
  for_each_piece(near.lists.size(), threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.isotropic_weights(near.rows(), near.offsets().data(), near.weight.data(),
                                    near.weight_correction.data()->data(),
                                    near.isotropic_weight.data(), begin, end);
  });
}

/// Makes inner walls dummies if they are above the surface of the snow, so that no pressure spreads
/// along a wall beyond the snow. Such a wall lacks more neighbours than it has snow: on a lattice
/// the surface is half a spacing above the topmost snow.
template <int D>
void leave_dry_walls(double n0, Particles<D>& particles, Neighbourhood<D>& near, int threads) {
  near.dry.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    near.dry[i] = false;
    if (particles.kind[i] != Kind::inner_wall) return;
    double snow = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      if (!particles.is_wall(near.lists.neighbour(e))) snow += double(near.weight[e]);
    near.dry[i] = snow == 0 || snow < n0 - double(near.weight_sum[i]);
  });
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    if (near.dry[i]) particles.kind[i] = Kind::dummy_wall;
  });
}

/// Sets first guesses of the pressures of inner walls, which are new in each step, to the
/// hydrostatic pressure of the snow around them.
template <int D>
void guess_wall_pressures(const Model<D>& model, Particles<D>& particles,
                          const Neighbourhood<D>& near) {
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    if (particles.kind[i] != Kind::inner_wall || near.surface[i]) return;
    double sum = 0, weight = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      if (particles.is_wall(j)) continue;
      sum += double(near.weight[e]) *
             (particles.pressure[j] -
              model.settings().density * model.gravity.dot(near.separation(e)));
      weight += double(near.weight[e]);
    }
    particles.pressure[i] = weight > 0 ? std::max(0.0, sum / weight) : 0.0;
  });
}

}  // namespace

template <int D>
const float* slope_without(Kind kind, const Model<D>& model, const Particles<D>& particles,
                           Neighbourhood<D>& near) {
  if (!model.has_wall_particles()) return near.slope.data();
  near.snow_slope.resize(near.lists.pairs());
  for_each_particle(near.lists.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      near.snow_slope[e] = particles.kind[near.lists.neighbour(e)] < kind ? near.slope[e] : 0.0f;
  });
  return near.snow_slope.data();
}

template <int D>
void find_neighbours(const Model<D>& model, Particles<D>& particles, double time,
                     Workspace<D>& work) {
  Neighbourhood<D>& near = work.near;
  const int threads = model.threads_for(particles.size());
  const double reach = model.reach(), period = model.options.period;
  near.cells.update(particles.position, reach, period);
  if (!near.cells.is_sorted()) {
    sort_particles(near.cells, particles, work.spare, threads);
    near.cells.update(particles.position, reach, period);
  }
  near.lists.update(particles.position, near.cells, reach, period, model.kernels.search, threads);
  find_contacts(model.options.obstacles, reach, particles, time, threads, near.contacts);
  weigh_pairs(model, near, threads);
  if (model.has_wall_particles()) {
    near.images.clear(particles.size());
    near.coupling = near.weight;
    leave_dry_walls(model.kernel.number_density, particles, near, threads);
  } else {
    near.dry.assign(particles.size(), false);
    near.images.update(near.lists, near.contacts, reach, model.settings().spacing, threads,
                       near.weight, near.coupling);
  }
  find_surface(model, particles, near, threads);
  if (model.has_wall_particles()) guess_wall_pressures(model, particles, near);
  if (model.settings().gradient == Gradient::corrected) {
    find_corrections(model, particles, near, threads);
    find_isotropic_weights(model, near, threads);
  } else {
    near.isotropic_weight = near.weight;
  }
}

template const float* slope_without(Kind, const Model<2>&, const Particles<2>&, Neighbourhood<2>&);
template const float* slope_without(Kind, const Model<3>&, const Particles<3>&, Neighbourhood<3>&);
template void find_neighbours(const Model<2>&, Particles<2>&, double, Workspace<2>&);
template void find_neighbours(const Model<3>&, Particles<3>&, double, Workspace<3>&);

}  // namespace snowshed::methods::mps
