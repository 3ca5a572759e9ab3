#include "snowshed/methods/mps/elastic_strain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// The slip along the walls after a step with this velocity, relative to the nearest of them. Along
/// each wall it is at most that at which the wall's friction is reached.
template <int D>
VecD<D> slip_after(const Model<D>& model, const Workspace<D>& work, double dt, const VecD<D>& slip,
                   const VecD<D>& velocity, std::size_t i) {
  const RowLists<WallContact<D>>& contacts = work.near.contacts;
  const WallContact<D>* nearest = nullptr;
  for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c)
    if (!nearest || c->distance < nearest->distance) nearest = c;
  if (!nearest) return VecD<D>::Zero();
  VecD<D> after = slip + dt * (velocity - nearest->velocity);
  const auto shorten = [&after](const VecD<D>& part, double most) {
    const double length = part.norm();
    if (length > most) after -= (1 - most / length) * part;
  };
  for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c)
    shorten(after - after.dot(c->normal) * c->normal,
            work.wall_friction.yield_slip[contacts.index_of(c)]);
  // Motion along the normal of the only wall has no effect, and must not add up.
  shorten(after, 2 * model.settings().yield_strain * model.settings().spacing);
  return after;
}

}  // namespace

template <int D>
Eigen::Matrix<double, D, D> strain_after(const Eigen::Matrix<double, D, D>& strain,
                                         const Eigen::Matrix<double, D, D>& gradient, double dt,
                                         double yield_strain) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const Matrix trial = strain + 0.5 * dt * (gradient + gradient.transpose());
  const double shear = std::sqrt(2.0) * trial.norm();
  const Matrix half_turn = 0.25 * dt * (gradient - gradient.transpose());
  const Matrix turn = (Matrix::Identity() - half_turn).inverse() * (Matrix::Identity() + half_turn);
  return std::min(1.0, yield_strain / std::max(shear, 1e-300)) * turn * trial * turn.transpose();
}

template <int D>
void find_elastic_rates(const Model<D>& model, double dt, const Particles<D>& particles,
                        Workspace<D>& work) {
  work.rates.elastic.resize(particles.size());
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.rates.elastic[i] = particles.elastic_strain[i] / dt;
  });
}

template <int D>
void update_elastic_strains(const Model<D>& model, double dt, Particles<D>& particles,
                            Workspace<D>& work) {
  find_rates(model, particles, work);
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    if (!particles.moves(i)) {
      particles.elastic_strain[i].setZero();
      particles.elastic_slip[i].setZero();
      return;
    }
    const Rheology& law = model.rheology;
    const double yield = law.yield_stress(law.friction > 0 ? work.rates.smooth_pressure[i] : 0.0);
    particles.elastic_strain[i] = strain_after<D>(
        particles.elastic_strain[i], work.rates.gradient[i], dt, dt * model.yield_rate(yield, dt));
    particles.elastic_slip[i] =
        slip_after(model, work, dt, particles.elastic_slip[i], particles.velocity[i], i);
  });
}

template Eigen::Matrix2d strain_after<2>(const Eigen::Matrix2d&, const Eigen::Matrix2d&, double,
                                         double);
template Eigen::Matrix3d strain_after<3>(const Eigen::Matrix3d&, const Eigen::Matrix3d&, double,
                                         double);
template void find_elastic_rates(const Model<2>&, double, const Particles<2>&, Workspace<2>&);
template void find_elastic_rates(const Model<3>&, double, const Particles<3>&, Workspace<3>&);
template void update_elastic_strains(const Model<2>&, double, Particles<2>&, Workspace<2>&);
template void update_elastic_strains(const Model<3>&, double, Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
