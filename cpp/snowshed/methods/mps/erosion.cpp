// Erosion of snow at rest, and deposition of moving snow.
#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// Largest distance, in l0, over which snow is deposited on snow at rest or a wall.
constexpr double max_deposition_distance = 1.5;

/// The largest squared speed of the neighbours, and whether the particle rests on snow at rest or
/// on a wall.
template <int D>
struct NearSnow {
  double fastest2 = 0;
  bool is_supported = false;

  NearSnow(const Model<D>& model, const Particles<D>& particles, const Neighbourhood<D>& near,
           std::size_t i) {
    const double limit = max_deposition_distance * model.settings().spacing;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      fastest2 = std::max(fastest2, particles.velocity[j].squaredNorm());
      is_supported = is_supported || (!particles.moves(j) && near.separation(e).norm() < limit);
    }
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c)
      is_supported = is_supported || (c->distance < limit && c->velocity.isZero());
  }
};

}  // namespace

/// Equation (23) is lost, and its form is inferred. An erodible particle begins to move if its
/// pressure is above p_e and a neighbour is faster than u_e. A moving particle is deposited on snow
/// at rest or on a wall if its pressure is below p_d and its speed below u_d. Because p_d < p_e and
/// u_d < u_e, a particle does not change back at once.
template <int D>
void erode_and_deposit(const Model<D>& model, Particles<D>& particles, Workspace<D>& work) {
  const Settings& s = model.settings();
  if (!s.erosion) return;
  work.changed.resize(particles.size());
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.changed[i] = false;
    const double pressure = particles.pressure[i];
    if (particles.kind[i] == Kind::erodible && pressure > s.erosion_pressure) {
      const NearSnow<D> around(model, particles, work.near, i);
      work.changed[i] = around.fastest2 > s.erosion_speed * s.erosion_speed;
    } else if (particles.moves(i) && pressure < s.deposition_pressure &&
               particles.velocity[i].squaredNorm() < s.deposition_speed * s.deposition_speed) {
      work.changed[i] = NearSnow<D>(model, particles, work.near, i).is_supported;
    }
  });
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    if (!work.changed[i]) return;
    const bool erodes = particles.kind[i] == Kind::erodible;
    particles.kind[i] = erodes ? Kind::moving : Kind::erodible;
    if (!erodes) particles.velocity[i].setZero();
  });
}

template void erode_and_deposit(const Model<2>&, Particles<2>&, Workspace<2>&);
template void erode_and_deposit(const Model<3>&, Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
