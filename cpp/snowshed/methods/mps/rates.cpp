// Shear rates and apparent viscosities.
#include <Eigen/LU>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"
#include "snowshed/methods/mps/moments.hpp"

namespace snowshed::methods::mps {
namespace {

/// The matrix, with the factor d/n0, that makes velocity gradients exact for linear velocities in
/// any arrangement of the neighbours (see find_corrections).
template <int D>
Eigen::Matrix<double, D, D> rate_correction(const Model<D>& model, const Neighbourhood<D>& near,
                                            std::size_t i) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const Matrix moment = model.gradient() * symmetric<D>(near.moments[i].slope);
  // 1 on a lattice; at the corners of a cube 0.04, and 0.02 with a radius of 3.1
  constexpr double min_determinant = D == 2 ? 0.05 : 0.01;
  if (!(moment.determinant() > min_determinant)) return model.gradient() * Matrix::Identity();
  return model.gradient() * moment.inverse();
}

/// The pressures of the last step, smoothed over the neighbours with the weight function and
/// clipped at zero. Behind walls the pressures continue hydrostatically, and above the free surface
/// with the opposite sign, so that smoothing does not change a linear pressure.
template <int D>
double smooth_pressure(const Model<D>& model, const Particles<D>& particles,
                       const Neighbourhood<D>& near, std::size_t i) {
  const double own_pressure = particles.pressure[i], n = near.density[i];
  double sum = own_pressure, weight = 1 + n;
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
    const std::size_t j = near.lists.neighbour(e);
    sum += double(near.weight[e]) *
           (particles.kind[j] == Kind::dummy_wall ? own_pressure : particles.pressure[j]);
  }
  const double weight_of_snow = model.settings().density;
  for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m) {
    double pressure = particles.pressure[m->neighbour];
    for (const int k : {0, 1})
      pressure += m->mirror_shift[k] * weight_of_snow *
                  std::max(0.0, -model.gravity.dot(near.wall(*m, k).normal));
    sum += double(m->weight) * pressure;
  }
  const double missing = near.surface[i] ? model.kernel.number_density - n : 0.0;
  if (missing > 0) {
    sum -= missing * own_pressure;
    weight += missing;
  }
  return std::max(0.0, sum / weight);
}

}  // namespace

template <int D>
void smooth_pressures(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  work.rates.smooth_pressure.resize(particles.size());
  if (model.rheology.friction == 0) return;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.rates.smooth_pressure[i] = smooth_pressure(model, particles, work.near, i);
  });
}

template <int D>
void prepare_rates(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  using Matrix = Eigen::Matrix<double, D, D>;
  Neighbourhood<D>& near = work.near;
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  near.moments.resize(n);
  work.rates.snow_slope = slope_without(Kind::inner_wall, model, particles, near);
  for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_moments(near.rows(), near.offsets().data(), near.weight.data(),
                              work.rates.snow_slope, near.moments.data(), begin, end);
  });
  work.rates.correction.resize(n);
  for_each_particle(n, threads, [&](std::size_t i) {
    work.rates.correction[i] =
        particles.is_wall(i) ? Matrix(Matrix::Zero()) : rate_correction(model, near, i);
  });
}

template <int D>
void sum_velocity_gradients(const Model<D>& model, const Particles<D>& particles,
                            const float* slope, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  work.rates.gradient.resize(particles.size());
  for_each_piece(particles.size(), model.threads_for(particles.size()),
                 [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                   model.kernels.sum_gradients(near.rows(), near.offsets().data(), slope,
                                               particles.velocity.data()->data(),
                                               work.rates.gradient.data()->data(), begin, end);
                 });
}

template <int D>
void find_rates(const Model<D>& model, Particles<D>& particles, Workspace<D>& work) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const int threads = model.threads_for(particles.size());
  sum_velocity_gradients(model, particles, work.rates.snow_slope, work);
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    Matrix& gradient = work.rates.gradient[i];
    gradient = Matrix(gradient * work.rates.correction[i]);
    particles.shear_rate[i] = shear_rate<D>(gradient);
  });
}

template <int D>
void find_viscosities(const Model<D>& model, Particles<D>& particles, const Workspace<D>& work) {
  const Rheology& law = model.rheology;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    const double pressure = law.friction > 0 ? work.rates.smooth_pressure[i] : 0.0;
    particles.viscosity[i] =
        law.apparent_viscosity(law.yield_stress(pressure), particles.shear_rate[i]);
  });
}

template void smooth_pressures(const Model<2>&, const Particles<2>&, Workspace<2>&);
template void smooth_pressures(const Model<3>&, const Particles<3>&, Workspace<3>&);
template void prepare_rates(const Model<2>&, const Particles<2>&, Workspace<2>&);
template void prepare_rates(const Model<3>&, const Particles<3>&, Workspace<3>&);
template void sum_velocity_gradients(const Model<2>&, const Particles<2>&, const float*,
                                     Workspace<2>&);
template void sum_velocity_gradients(const Model<3>&, const Particles<3>&, const float*,
                                     Workspace<3>&);
template void find_rates(const Model<2>&, Particles<2>&, Workspace<2>&);
template void find_rates(const Model<3>&, Particles<3>&, Workspace<3>&);
template void find_viscosities(const Model<2>&, Particles<2>&, const Workspace<2>&);
template void find_viscosities(const Model<3>&, Particles<3>&, const Workspace<3>&);

}  // namespace snowshed::methods::mps
