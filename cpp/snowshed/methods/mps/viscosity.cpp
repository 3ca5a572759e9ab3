// The implicit viscous term.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed {
namespace {

/// Nearer to a wall than this, in l0, its friction grows no further.
constexpr double nearest_friction = 0.25;

/// The viscosity between two particles: their harmonic mean, so that the stress is that of both.
inline double between(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0.0; }

}  // namespace

/// The wall's shear stress is that of the snow at the rate u/h with which it slides by, h its
/// distance; the velocity continues linearly into the wall and is zero at the surface. Its
/// frictional part follows from the force with which the wall supports the particle, so that the
/// friction of all particles is Coulomb's of their weight, however they lie. Where the obstacle is
/// not sticky, it is at most the obstacle's own friction.
template <int D>
double wall_drag(const MpsModel<D>& model, const MpsParticles<D>& particles, const MpsWork<D>& work,
                 std::size_t i, const WallContact<D>& c) {
  const MpsSettings& s = model.settings();
  const double height = std::max(c.distance, nearest_friction * s.spacing);
  const VecD<D> relative = particles.velocity[i] - c.velocity;
  const double rate = (relative - relative.dot(c.normal) * c.normal).norm() / height;
  const Rheology& law = model.rheology;
  // Each wall that a particle touches bears a part; they share by the number of contacts.
  const double walls = double(work.near.contacts.end(i) - work.near.contacts.begin(i));
  const double support = particles.support[i] / walls;
  const double drag = law.apparent_viscosity(law.cohesion, rate) / s.density *
                          model.wall_friction.at(c.distance / s.spacing) / (s.spacing * height) +
                      law.regularised(law.friction * support, rate) / height;
  const ContactLaw& contact = model.options.obstacles[c.obstacle].law;
  if (contact.condition == Condition::sticky) return drag;
  return std::min(drag, law.regularised(contact.friction * support, rate) / height);
}

template <int D>
SolveReport apply_viscosity(const MpsModel<D>& model, double dt, MpsParticles<D>& particles,
                            MpsWork<D>& work) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  const MpsNeighbourhood<D>& near = work.near;
  const double factor = dt / model.settings().density * model.laplacian();
  work.velocity.resize(n);
  work.block.resize(n);
  work.inverse_block.resize(n);
  work.coupling.resize(near.lists.pairs());
  work.drag.resize(near.contacts.all().size());
  for_each_particle(n, threads, [&](std::size_t i) {
    const bool moves = particles.moves(i);
    double sum = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      const double c =
          factor * between(particles.viscosity[i], particles.viscosity[j]) * double(near.weight[e]);
      work.coupling[e] = float(c);
      sum += double(work.coupling[e]);
    }
    Matrix block = (1 + sum) * Matrix::Identity();
    VecD<D> right = particles.velocity[i] + dt * model.gravity;
    if (moves)
      for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
        double& drag = work.drag[near.contacts.place(c)];
        drag = wall_drag(model, particles, work, i, *c);
        const Matrix along = dt * drag * (Matrix::Identity() - c->normal * c->normal.transpose());
        block += along;
        right += along * c->velocity;
      }
    work.velocity[i] = moves ? right : VecD<D>(VecD<D>::Zero());
    work.block[i] = moves ? block : Matrix(Matrix::Zero());
    work.inverse_block[i] = moves ? Matrix(block.inverse()) : Matrix(Matrix::Zero());
  });

  double speed2 = 0;
  for (const VecD<D>& u : particles.velocity) speed2 += u.squaredNorm();
  const double scale = std::sqrt(double(n)) * model.gravity.norm() * dt + 1e-3 * std::sqrt(speed2);
  const std::uint32_t *first = near.lists.first(), *index = near.lists.index();
  const auto as_vectors = [](const double* values) {
    return reinterpret_cast<const VecD<D>*>(values);
  };
  const auto apply = [&](const double* p, double* q) {
    const VecD<D>* const in = as_vectors(p);
    for_each_particle(n, threads, [&](std::size_t i) {
      VecD<D> sum = work.block[i] * in[i];
      if (particles.moves(i))
        for (std::uint32_t e = first[i]; e < first[i + 1]; ++e)
          sum -= double(work.coupling[e]) * in[index[e]];
      VecD<D>::Map(q + i * D) = sum;
    });
  };
  const auto precondition = [&](const double* r, double* z) {
    for_each_particle(n, threads, [&](std::size_t i) {
      VecD<D>::Map(z + i * D) = work.inverse_block[i] * as_vectors(r)[i];
    });
  };
  return conjugate_gradients(n * D, model.settings().viscosity_tolerance, scale,
                             model.settings().max_iterations, threads, work.cg,
                             particles.velocity.data()->data(), work.velocity.data()->data(), apply,
                             precondition);
}

template double wall_drag(const MpsModel<2>&, const MpsParticles<2>&, const MpsWork<2>&,
                          std::size_t, const WallContact<2>&);
template double wall_drag(const MpsModel<3>&, const MpsParticles<3>&, const MpsWork<3>&,
                          std::size_t, const WallContact<3>&);
template SolveReport apply_viscosity(const MpsModel<2>&, double, MpsParticles<2>&, MpsWork<2>&);
template SolveReport apply_viscosity(const MpsModel<3>&, double, MpsParticles<3>&, MpsWork<3>&);

}  // namespace snowshed
